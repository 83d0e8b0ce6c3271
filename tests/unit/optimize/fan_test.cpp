// fan_test.cpp — thin elements round one edge: nothing helps, and that is found out soon.
#include "optimize/optimize.hpp"
#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>
#include <numbers>

using namespace molmesh;

namespace {

/// n elements round an edge from {0, 0, 0} to {0, 0, 1}, whose other corners are on a circle.
TetMesh fan(int n) {
  TetMesh mesh;
  mesh.point = {{0, 0, 0}, {0, 0, 1}};
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * k / n;
    mesh.point.push_back({std::cos(angle), std::sin(angle), 0.5});
    const int a = 2 + k, b = 2 + (k + 1) % n;
    mesh.tet.push_back({0, 1, a, b});
    mesh.region.push_back(molecule);
    mesh.tri.insert(mesh.tri.end(), {{0, b, a}, {1, a, b}});
    mesh.boundary.insert(mesh.boundary.end(), 2, surface);
  }
  return mesh;
}

} // namespace

TEST_CASE("time is bounded by a multiple of the elements, those of fans too") {
  for (const int n : {50, 200, 1000}) {
    const TetMesh before = fan(n);
    TetMesh mesh = before;
    const std::clock_t start = std::clock();
    const optimize::Result result = optimize::improve(mesh, nullptr, {});
    INFO(n << " elements, " << result.looks << " looks");
    CHECK(double(std::clock() - start) / CLOCKS_PER_SEC < 5); // a minute for 1,000 without a bound
    CHECK(result.looks > 100 * n);                            // tried they were
    CHECK(result.looks < 15'000'000 + 25'000 * n);
    CHECK(result.after.min >= result.before.min);
    CHECK(result.after.max <= std::max(result.before.max, 140.));
    TetMesh again = before;
    optimize::Options four;
    four.threads = 4;
    CHECK(optimize::improve(again, nullptr, four).looks == result.looks);
    CHECK(again.tet == mesh.tet);
  }
}
