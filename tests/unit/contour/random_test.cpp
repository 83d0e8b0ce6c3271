// random_test.cpp — random densities: valid meshes, uniform ones with the topology of the trilinear isosurface.
#include "contour/contour.hpp"
#include "unit/contour/checked.hpp"
#include "unit/contour/sample_grid.hpp"
#include "unit/contour/trilinear_euler.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace molmesh;
using namespace molmesh::test;
using contour::Options;

TEST_CASE("random densities: always valid, ties with the isovalue among them", "[slow]") {
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

TEST_CASE("uniform meshes have the Euler number of the trilinear isosurface", "[slow]") {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> u(0, 2);
  for (int trial = 0; trial < 40; ++trial) {
    const bool ties = trial % 2 != 0; // three values in ten at the isovalue: outside
    const auto grid_of = [&](float at_isovalue, std::mt19937_64 r) {
      return test::sample_grid({0, 0, 0}, {8, 8, 8}, 1, 3, [&](Vec3d x) {
        const bool border = std::min({x.x, x.y, x.z}) < 0.5 || std::max({x.x, x.y, x.z}) > 6.5;
        const bool tie = ties && u(r) < 0.6;
        return border ? 0.2 : tie ? double(at_isovalue) : u(r);
      });
    };
    const BlockGrid grid = grid_of(1, random), below = grid_of(std::nextafter(1.0f, 0.0f), random);
    random.discard(2000);
    Options options;
    options.adapt = 0;
    const Validity v = checked(mesh_of(grid, options));
    CAPTURE(trial);
    CHECK(v.surface.euler == trilinear_euler(below));
    CHECK(v.surface.euler == trilinear_euler(grid));
  }
}
