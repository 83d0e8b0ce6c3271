// random_test.cpp — random densities: valid meshes, uniform ones with the topology of the trilinear isosurface.
#include "contour/contour.hpp"
#include "contour/cube.hpp"
#include "unit/contour/checked.hpp"
#include "unit/contour/sample_grid.hpp"
#include <array>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using namespace molmesh;
using namespace molmesh::test;
using contour::Options;

namespace {

/// Euler number of the trilinear isosurface without a mesh: twice that of its inside, which is the alternating sum
/// over cells, faces, edges and points of the Euler numbers of the inside's parts there.
int64_t trilinear_euler(const BlockGrid& grid) {
  const BlockIndex index(grid);
  int64_t chi = 0;
  Vec3i p;
  const Vec3i end = grid.frame.lower + grid.frame.points - Vec3i{1, 1, 1};
  for (p.x = grid.frame.lower.x; p.x < end.x; ++p.x)
    for (p.y = grid.frame.lower.y; p.y < end.y; ++p.y)
      for (p.z = grid.frame.lower.z; p.z < end.z; ++p.z) {
        double v[8];
        for (int c = 0; c < 8; ++c)
          v[c] = value_at(grid, index, p + Vec3i{c & 1, c >> 1 & 1, c >> 2}) - grid.info.isovalue;
        std::array<int, 8> parent;
        std::iota(parent.begin(), parent.end(), 0);
        const auto find = [&](int i) {
          while (parent[static_cast<size_t>(i)] != i)
            i = parent[static_cast<size_t>(i)];
          return i;
        };
        const auto join = [&](int i, int j) { parent[static_cast<size_t>(find(i))] = find(j); };
        for (int c = 0; c < 8; ++c)
          for (int bit = 1; bit < 8; bit *= 2)
            if ((v[c] > 0) == (v[c ^ bit] > 0))
              join(c, c ^ bit);
        for (int f = 0; f < 6; ++f) {
          const int c[4] = {contour::face_corner_of(f, 0), contour::face_corner_of(f, 1),
                            contour::face_corner_of(f, 2), contour::face_corner_of(f, 3)};
          const contour::Diagonal d = contour::face_diagonal(v[c[0]], v[c[1]], v[c[2]], v[c[3]]);
          if (d != contour::Diagonal::none)
            join(contour::diagonal_corners(f, d)[0], contour::diagonal_corners(f, d)[1]);
          if (f % 2)
            continue; // each face once
          const int in = (v[c[0]] > 0) + (v[c[1]] > 0) + (v[c[2]] > 0) + (v[c[3]] > 0);
          const bool apart = d != contour::Diagonal::none && !(v[contour::diagonal_corners(f, d)[0]] > 0);
          chi -= in == 0 ? 0 : apart ? 2 : 1;
        }
        for (int c : {1, 2, 4})
          chi += v[0] > 0 || v[c] > 0;
        chi -= v[0] > 0;
        // The inside's parts in the cell, less the tunnels that the outside makes through them.
        const std::array<int, 8> label = contour::trilinear_components(v);
        for (int c = 0; c < 8; ++c)
          chi +=
              v[c] > 0 ? label[static_cast<size_t>(c)] == c : (label[static_cast<size_t>(c)] == c) - (find(c) == c);
      }
  return 2 * chi;
}

} // namespace

TEST_CASE("random densities: always valid, ties with the isovalue among them") {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 36; ++trial) {
    const BlockGrid grid = random_grid(random, trial);
    for (auto meshed : {Options::interior, Options::exterior, Options::both})
      for (double adapt : {0.0, 0.3}) {
        CAPTURE(trial, int(meshed), adapt);
        Options options;
        options.meshed = meshed;
        options.adapt = adapt;
        checked(mesh_of(grid, options));
      }
  }
}

/// By hand, before a release: test_contour '[thousand]'
TEST_CASE("a thousand random densities: always valid, ties with the isovalue among them", "[.][thousand]") {
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 1000; ++trial) {
    const BlockGrid grid = random_grid(random, trial);
    for (double adapt : {0.0, contour::default_adapt(grid.frame.spacing)}) {
      CAPTURE(trial, adapt);
      Options options;
      options.meshed = Options::both;
      options.adapt = adapt;
      checked(mesh_of(grid, options));
    }
  }
}

TEST_CASE("uniform meshes have the Euler number of the trilinear isosurface") {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> u(0, 2);
  for (int trial = 0; trial < 40; ++trial) {
    const BlockGrid grid = test::sample_grid({0, 0, 0}, {8, 8, 8}, 1, 3, [&](Vec3d x) {
      const bool rim = std::min({x.x, x.y, x.z}) < 0.5 || std::max({x.x, x.y, x.z}) > 6.5;
      return rim ? 0.2 : u(random);
    });
    Options options;
    options.adapt = 0;
    const Validity v = checked(mesh_of(grid, options));
    CAPTURE(trial);
    CHECK(v.surface.euler == trilinear_euler(grid));
  }
}
