// fan_test.cpp — thin elements round one edge: nothing helps, and that is found out soon.
#include "mesh/adjacency.hpp"
#include "optimize/optimize.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

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

/// Three layers of n * n boxes of six elements each, 1 * 1 * 0.01.
TetMesh plate(int n) {
  TetMesh mesh;
  const auto at = [n](int x, int y, int z) { return (x * (n + 1) + y) * 4 + z; };
  for (int x = 0; x <= n; ++x)
    for (int y = 0; y <= n; ++y)
      for (int z = 0; z < 4; ++z)
        mesh.point.push_back({double(x), double(y), 0.01 * z});
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y)
      for (int z = 0; z < 3; ++z) {
        std::array<int, 3> axis = {0, 1, 2};
        do { // from corner to corner along the axes in any order
          std::array<int, 3> c = {x, y, z};
          Tet t = {at(x, y, z), 0, 0, 0};
          for (size_t k = 0; k < 3; ++k) {
            ++c[size_t(axis[k])];
            t[k + 1] = at(c[0], c[1], c[2]);
          }
          const auto p = [&](size_t i) { return mesh.point[t[i]]; };
          if (dot(cross(p(1) - p(0), p(2) - p(0)), p(3) - p(0)) < 0)
            std::swap(t[1], t[2]);
          mesh.tet.push_back(t);
          mesh.region.push_back(molecule);
        } while (std::next_permutation(axis.begin(), axis.end()));
      }
  rebuild_triangles(mesh);
  return mesh;
}

} // namespace

TEST_CASE("work is bounded by a multiple of the elements, that of fans too") {
  for (const int n : {50, 200, 1000, 5000}) {
    const TetMesh before = fan(n);
    TetMesh mesh = before;
    const optimize::Result result = optimize::improve(mesh, nullptr, {});
    INFO(n << " elements, " << result.looks << " looks");
    CHECK(result.looks > 100 * n);             // tried they were
    CHECK(result.looks < 100'000 + 9'000 * n); // of some nanoseconds each: tests/bench/fans.py
    CHECK(result.after.min >= result.before.min);
    CHECK(result.after.max <= std::max(result.before.max, 140.));
    TetMesh again = before;
    optimize::Options four;
    four.threads = 4;
    CHECK(optimize::improve(again, nullptr, four).looks == result.looks);
    CHECK(again.tet == mesh.tet);
  }
}

TEST_CASE("what always finds one more operation to do is given up, too") {
  const TetMesh before = plate(5);
  const auto elements = static_cast<int64_t>(before.tet.size());
  TetMesh mesh = before;
  const optimize::Result result = optimize::improve(mesh, nullptr, {});
  INFO(elements << " elements, " << result.looks << " looks");
  CHECK(result.counts.total() > 4 * elements + 2000); // more than earn looks
  CHECK(result.looks < 1.2 * (40e6 + 90e3 * double(elements)));
  CHECK(result.after.min >= result.before.min);
}
