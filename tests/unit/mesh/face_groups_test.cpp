// face_groups_test.cpp — faces and triangles on the same three points, against a table of all of them.
#include "mesh/face_groups.hpp"
#include "meshes.hpp"
#include <catch2/catch.hpp>
#include <map>
#include <mutex>
#include <numeric>
#include <random>

using namespace molmesh;
using namespace molmesh::testing;

namespace {

using Groups = std::map<Tri, std::pair<std::vector<uint32_t>, bool>>;

Tri sorted(Tri t) {
  std::sort(t.begin(), t.end());
  return t;
}

Groups by_table(const TetMesh& m) {
  Groups all;
  for (int64_t f = 0; f < int64_t(4 * m.tet.size()); ++f)
    all[sorted(face_points(m, f))].first.push_back(uint32_t(f));
  for (size_t t = 0; t < m.tri.size(); ++t)
    all[sorted(m.tri[t])].first.push_back(uint32_t(4 * m.tet.size() + t));
  for (auto& [points, group] : all) // from both sides a face is seen the other way round
    if (group.first.size() > 1 && group.first[1] < 4 * m.tet.size())
      group.second = same_turn(face_points(m, group.first[0]), face_points(m, group.first[1]));
  return all;
}

Groups by_groups(const TetMesh& m, int threads) {
  Groups all;
  std::mutex guard;
  for_each_face(m.tet, m.tri, int64_t(m.point.size()), threads, [&](const uint32_t* face, int n, bool same_side) {
    const auto tets = int64_t(m.tet.size());
    const Tri points = sorted(face[0] < 4 * tets ? face_points(m, face[0]) : m.tri[face[0] - size_t(4 * tets)]);
    const std::lock_guard<std::mutex> lock(guard);
    CHECK(all.try_emplace(points, std::vector<uint32_t>(face, face + n), same_side).second);
  });
  return all;
}

} // namespace

TEST_CASE("faces and triangles come together on their points, whatever the numbers") {
  TetMesh m = cubes(GENERATE(1, 3, 12), [](Vec3i c) { return c.x % 2 == 0 ? Region::molecule : Region::outside; });
  std::mt19937 random_bits(11);
  std::vector<int32_t> number(m.point.size());
  std::iota(number.begin(), number.end(), 0);
  const bool mixed = GENERATE(false, true);
  if (mixed)
    std::shuffle(number.begin(), number.end(), random_bits);
  for (Tet& t : m.tet) {
    for (int32_t& v : t)
      v = number[v];
    if (mixed) // an even permutation
      std::rotate(t.begin() + 1, t.begin() + 1 + random_bits() % 3, t.end());
  }
  for (Tri& t : m.tri)
    for (int32_t& v : t)
      v = number[v];
  const Groups expected = by_table(m);
  for (const int threads : {1, 2, 5})
    CHECK((by_groups(m, threads) == expected)); // not printed
}

TEST_CASE("faces of three, of two on one side, triangles twice and nowhere, and one point in all") {
  TetMesh m;
  m.point.resize(40);
  m.tet = {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}, {6, 7, 8, 9}, {6, 7, 8, 10}};
  for (int32_t v = 11; v + 2 < 40; ++v)
    m.tet.push_back({v, v + 1, v + 2, 0});
  m.tri = {{0, 1, 2}, {2, 1, 0}, {6, 8, 7}, {3, 6, 9}};
  const Groups expected = by_table(m);
  CHECK(expected.at({0, 1, 2}).first.size() == 5);
  CHECK(expected.at({6, 7, 8}).second);
  for (const int threads : {1, 4})
    CHECK((by_groups(m, threads) == expected));
}

TEST_CASE("no tetrahedra have no faces") {
  bool called = false;
  for_each_face({}, {}, 0, 2, [&](const uint32_t*, int, bool) { called = true; });
  CHECK_FALSE(called);
}
