// simd_test.cpp — eight places at once give the same bits as one at a time, on every instruction set.
#include "base/log.hpp"
#include "isosurface/guard.hpp"
#include "isosurface/isosurface.hpp"
#include "isosurface/logs_simd.hpp"
#include "isosurface/probe_simd.hpp"
#include "unit/instruction_sets.hpp"
#include "unit/optimize/lattice_mesh.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace molmesh;
using molmesh::test::with_every_instruction_set;

namespace {

std::mt19937 generator(11);
Vec3d random_point(double size) {
  std::uniform_real_distribution<double> u(-size, size);
  return {u(generator), u(generator), u(generator)};
}

const Vec3d centre{4.03, 4.11, 3.97};
constexpr double radius = 1.7, h = 0.25;
Isosurface ball() {
  Isosurface surface(
      test::lattice_grid([](Vec3d p) { return std::exp(-0.3 * (norm2(p - centre) - radius * radius)); }, {0, 0, 0},
                         h, 32),
      1);
  surface.set_offset(0.01 * h);
  return surface;
}

// On both sides of the band's ends, in cells across blocks, and where there is no grid.
Vec3d somewhere() {
  const Vec3d d = random_point(1);
  std::uniform_real_distribution<double> off(-1.2, 1.2);
  const int kind = static_cast<int>(generator() % 20);
  return kind == 0   ? Vec3d{1e300, 0, 0}
         : kind == 1 ? centre + 100. * d
                     : centre + (radius + off(generator)) / norm(d) * d;
}

void check_same(Vec3d a, Vec3d b) {
  CHECK(a.x == b.x);
  CHECK(a.y == b.y);
  CHECK(a.z == b.z);
}

} // namespace

TEST_CASE("eight places are probed as one is") {
  const Isosurface surface = ball();
  with_every_instruction_set([&] {
    int known = 0;
    for (int round = 0; round < 200; ++round) {
      const int n = 1 + round % 8;
      EightPlaces p;
      for (size_t i = 0; i < 8; ++i)
        p.set(i, somewhere());
      EightProbes probes;
      probes.known = 0xabcd; // of an earlier question
      surface.probe_eight(p, n, probes);
      CHECK(probes.known >> n == 0);
      for (size_t i = 0; i < size_t(n); ++i) {
        double distance;
        Vec3d normal;
        REQUIRE(probes.is_known(i) == surface.probe(p[i], distance, normal));
        if (!probes.is_known(i))
          continue;
        ++known;
        CHECK(probes.distance[i] == distance);
        check_same(probes.normal[i], normal);
      }
    }
    CHECK(known > 100);
    CHECK(known < 900);
  });
}

TEST_CASE("eight places are put on the isosurface as one is") {
  const Isosurface surface = ball();
  with_every_instruction_set([&] {
    int on = 0;
    for (int round = 0; round < 200; ++round) {
      const int n = 1 + round % 8;
      const double reach = round % 3 == 0 ? 0.1 : 1;
      EightPlaces p, from;
      for (size_t i = 0; i < 8; ++i)
        from.set(i, somewhere());
      p = from;
      const uint32_t bits = surface.project_eight(p, n, reach);
      CHECK(bits >> n == 0);
      for (size_t i = 0; i < size_t(n); ++i) {
        Vec3d q = from[i];
        REQUIRE((bits >> i & 1) == surface.project(q, reach));
        if (bits >> i & 1) {
          ++on;
          check_same(p[i], q);
        }
      }
    }
    CHECK(on > 100);
    CHECK(on < 900);
  });
}

TEST_CASE("the logarithms of 64 values are taken as one is") {
  constexpr double isovalue = 0.7;
  with_every_instruction_set([&] {
    std::uniform_real_distribution<float> value(-0.2f, 1.5f);
    for (int round = 0; round < 100; ++round) {
      float v[64], log[64];
      for (float& of : v)
        of = value(generator);
      v[3] = 0, v[7] = 1e-30f, v[20] = static_cast<float>(isovalue), v[33] = 3e38f;
      const uint64_t active = round == 0   ? 0
                              : round == 1 ? ~uint64_t{0}
                                           : uint64_t{generator()} << 32 | uint64_t{generator()};
      log_ratios(v, active, isovalue, log);
      for (int i = 0; i < 64; ++i)
        if (active >> i & 1 && v[i] > 0)
          CHECK(log[i] == static_cast<float>(portable_log(v[i] / isovalue)));
        else
          CHECK(std::isnan(log[i]));
    }
  });
}

TEST_CASE("eight triangles fit the target as one does") {
  const Isosurface surface = ball();
  const Guard guard;
  with_every_instruction_set([&] {
    for (int round = 0; round < 200; ++round) {
      EightTriangles t;
      for (size_t i = 0; i < 8; ++i) {
        const Vec3d a = somewhere();
        t.a.set(i, a);
        t.b.set(i, round % 10 == 0 ? a : a + random_point(h)); // some have no area
        t.c.set(i, a + random_point(h));
      }
      EightPlaces centroid;
      centroids(t, centroid);
      EightProbes probes;
      surface.probe_eight(centroid, 8, probes);
      double misfit[8];
      misfits(t, probes, guard.distance * surface.spacing(), guard.tilt(), misfit);
      for (size_t i = 0; i < 8; ++i)
        CHECK(misfit[i] == molmesh::misfit(surface, guard, guard.tilt(), t.a[i], t.b[i], t.c[i]));
    }
  });
}
