// sampled_plan_test.cpp — cubes of a grid tell what counting all of it tells.
#include "density/sampled_plan.hpp"
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace molmesh;

namespace {

/// A shell of atoms, residue by residue along a spiral on the sphere, in two chains.
Hierarchy shell(double p_chain, double p_residue) {
  constexpr int64_t residues = 8000, atoms = 8;
  constexpr double radius = 110, thickness = 25;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> even(0, 1);
  Hierarchy h;
  h.level = {{"chain", {}}, {"residue", {}}};
  h.level[0].group = {{"A", p_chain, 0, residues / 2}, {"B", p_chain, residues / 2, residues}};
  for (int64_t r = 0; r < residues; ++r) {
    h.level[1].group.push_back({"R", p_residue, r * atoms, (r + 1) * atoms});
    const double z = 1 - 2 * (double(r) + 0.5) / double(residues), angle = 2.39996 * double(r),
                 from = radius - thickness * even(random), around = std::sqrt(1 - z * z);
    const Vec3d middle = from * Vec3d{around * std::cos(angle), around * std::sin(angle), z};
    for (int64_t a = 0; a < atoms; ++a) {
      Atom atom;
      atom.center = middle + Vec3d{5 * even(random), 5 * even(random), 5 * even(random)};
      atom.radius = 1.5 + 0.4 * even(random);
      h.atom.push_back(atom);
    }
  }
  return h;
}

double ratio(int64_t a, int64_t b) {
  return double(a) / double(b);
}

} // namespace

TEST_CASE("samples tell the points, blocks and margin of the whole") {
  for (const auto& [p_chain, p_residue] : {std::pair{1., 1.}, {1., 0.3}, {0.5, 0.2}}) {
    const Hierarchy h = shell(p_chain, p_residue);
    density::Options o;
    o.spacing = 1.5;
    CAPTURE(p_chain, p_residue);
    for (const int64_t points : {0, 160}) {
      o.grid_points = points;
      const auto sampled = density::sampled_plan(h, o, 20'000);
      REQUIRE(sampled);
      density::Counts counts;
      const Band band = density::compute(h, o, counts);
      CHECK(sampled->sample.size() >= 6);
      CHECK(sampled->size.points == band.frame.points);
      CHECK(sampled->size.spacing == Approx(band.frame.spacing).epsilon(1e-4));
      CHECK(sampled->margin == Approx(counts.margin).margin(0.011));
      CHECK(std::abs(ratio(sampled->size.active_points, band.active_points) - 1) < 0.15);
      CHECK(std::abs(ratio(sampled->size.blocks, std::ssize(band.block)) - 1) < 0.15);
    }
  }
}

TEST_CASE("samples are the same for any number of threads") {
  const Hierarchy h = shell(1, 0.3);
  density::Options o;
  o.spacing = 2;
  const auto one = density::sampled_plan(h, o, 20'000);
  o.threads = 3;
  const auto three = density::sampled_plan(h, o, 20'000);
  REQUIRE((one && three));
  CHECK(one->size.active_points == three->size.active_points);
  CHECK(one->margin == three->margin);
  REQUIRE(one->sample.size() == three->sample.size());
  for (size_t i = 0; i < one->sample.size(); ++i)
    CHECK(one->sample[i].weight == three->sample[i].weight);
}

TEST_CASE("a cube of samples holds the values of the run") {
  const Hierarchy h = shell(0.5, 0.2);
  density::Options o;
  o.spacing = 1.5;
  const auto sampled = density::sampled_plan(h, o, 20'000);
  REQUIRE(sampled);
  REQUIRE(sampled->counted.spacing == 1.5);
  density::Counts counts;
  const BlockGrid whole = to_block_grid(density::compute(h, o, counts), 1);
  const BlockIndex index(whole);
  int64_t compared = 0;
  for (const density::PlanSample& s : sampled->sample) {
    const BlockGrid cube = to_block_grid(s.band, 1);
    // The margins are both found to 0.01 Å: by so much the grids are apart.
    const Vec3d shift = (cube.frame.origin - whole.frame.origin) / 1.5;
    const Vec3i at{static_cast<int32_t>(std::lround(shift.x)), static_cast<int32_t>(std::lround(shift.y)),
                   static_cast<int32_t>(std::lround(shift.z))};
    for (size_t b = 0; b < cube.corner.size(); ++b)
      for (int i = 0; i < 512; ++i) {
        const Vec3i p = cube.corner[b] + within_block(i), q = p + at;
        const int64_t other = index.find(q);
        if (!(cube.active[8 * b + size_t(i) / 64] >> (i & 63) & 1) || other < 0 ||
            !(whole.active[8 * size_t(other) + size_t(slot(q)) / 64] >> (slot(q) & 63) & 1))
          continue;
        const double a = cube.value[512 * b + size_t(i)], v = whole.value[512 * size_t(other) + size_t(slot(q))];
        if (std::abs(a - v) > 0.02 * std::max(1., v))
          FAIL("found " << a << ", expected " << v);
        ++compared;
      }
  }
  CHECK(compared > 10'000);
}

TEST_CASE("what cannot be told from cubes is not") {
  Hierarchy h = shell(1, 1);
  density::Options o;
  o.spacing = 2;
  REQUIRE(density::sampled_plan(h, o, 20'000));
  density::Options other = o;
  other.margin = 10;
  CHECK_FALSE(density::sampled_plan(h, other, 20'000));
  other = o;
  other.tile = {1, 2};
  CHECK_FALSE(density::sampled_plan(h, other, 20'000));
  other = o;
  other.isovalue = 1e9;
  other.band_lower = 9e8, other.band_upper = 1.1e9;
  CHECK_FALSE(density::sampled_plan(h, other, 20'000));
  h.atom[5].radius = 1000;
  CHECK_FALSE(density::sampled_plan(h, o, 20'000));
}
