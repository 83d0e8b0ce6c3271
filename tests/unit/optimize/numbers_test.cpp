// numbers_test.cpp — numbers of vertices, of neighbours, and the extreme angles, each by the slow way.
#include "base/open_table.hpp"
#include "lattice_mesh.hpp"
#include "mesh/adjacency.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include "optimize/mesh/measures.hpp"
#include "optimize/optimize.hpp"
#include <catch2/catch.hpp>
#include <map>
#include <random>

using namespace molmesh;
using namespace molmesh::test;

namespace {

std::mt19937 random_bits(5);

} // namespace

TEST_CASE("vertices are numbered in the order they are met") {
  SmallNumbers number;
  for (int round = 0; round < 20; ++round) {
    number.clear();
    std::map<int32_t, size_t> slow;
    for (int k = 0; k < 60 * round; ++k) {
      const auto v = static_cast<int32_t>(random_bits() % uint32_t(10 + 50 * round)) * 1024;
      const size_t expected = slow.try_emplace(v, slow.size()).first->second;
      REQUIRE(number(v) == expected);
      REQUIRE(number.met()[expected] == v);
    }
    CHECK(number.met().size() == slow.size());
  }
}

TEST_CASE("the improved mesh comes with its neighbours and its own extreme angles") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, 0.5, 20);
  TetMesh mesh = lattice_mesh(three_atoms, {0, 0, 0}, 0.5, 20, GENERATE(0, 1, 2));
  const auto extremes = [](const TetMesh& m) {
    optimize::Angles a;
    for (const Tet& t : m.tet) {
      double least = 180, most = 0;
      for (size_t i = 0; i < 4; ++i)
        for (size_t j = i + 1; j < 4; ++j) {
          const size_t k = i == 0 ? (j == 1 ? 2 : 1) : 0, l = 6 - i - j - k; // the edge k l, seen from i and j
          const Vec3d e = m.point[t[l]] - m.point[t[k]], unit = e / norm(e);
          const Vec3d x = m.point[t[i]] - m.point[t[k]], y = m.point[t[j]] - m.point[t[k]];
          const Vec3d u = x - dot(x, unit) * unit, v = y - dot(y, unit) * unit;
          const double angle = std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / 3.14159265358979323846;
          least = std::min(least, angle), most = std::max(most, angle);
        }
      a.min = std::min(a.min, least), a.max = std::max(a.max, most);
      a.below_25 += least<25, a.above_140 += most> 140;
    }
    return a;
  };
  const optimize::Angles before = extremes(mesh);
  optimize::Options options;
  optimize::Result result = optimize::improve(mesh, &grid, options);
  CHECK(result.fidelity.points > 0);
  const optimize::Angles after = extremes(mesh);
  LargeArray<int32_t> across = face_neighbors(mesh, 1);
  for (int32_t& f : across)
    f = f < 0 ? -1 : f / 4;
  CHECK((result.across == across)); // not printed
  CHECK(before.below_25 > 0);
  CHECK(result.before.below_25 == before.below_25);
  CHECK(result.before.above_140 == before.above_140);
  CHECK(result.before.min == Approx(before.min));
  CHECK(result.before.max == Approx(before.max));
  CHECK(result.after.min == Approx(after.min));
  CHECK(result.after.max == Approx(after.max));
}
