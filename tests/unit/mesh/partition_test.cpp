// partition_test.cpp — parts are even, few faces lie between them, threads do not matter.
#include "mesh/partition.hpp"
#include "meshes.hpp"
#include "unit/cli/child.hpp"
#include <catch2/catch.hpp>
#include <numeric>

using namespace molmesh;
using namespace molmesh::testing;

TEST_CASE("parts are even and compact, the same at any number of threads") {
  const int n = GENERATE(16, 30); // by elements, by clusters of elements
  const TetMesh m = cubes(n, all_molecule);
  REQUIRE((m.tet.size() > 131072) == (n == 30));
  const std::vector<int32_t> part = partition(m, 8, 2);
  REQUIRE(part.size() == m.tet.size());
  std::vector<size_t> size(8);
  for (int32_t p : part)
    ++size.at(static_cast<size_t>(p));
  for (size_t s : size)
    CHECK(s == Approx(double(m.tet.size()) / 8).epsilon(0.05));
  const LargeArray<int32_t> across = face_neighbors(m, 1);
  size_t cut = 0;
  for (size_t f = 0; f < across.size(); ++f)
    cut += across[f] >= 0 && part[f / 4] != part[static_cast<size_t>(across[f]) / 4];
  // Eight octants would cut three planes of n x n squares, two triangles each, seen from both sides.
  CHECK(cut / 2 < static_cast<size_t>(2 * 3 * n * n * 2));
  CHECK(partition(m, 8, 1) == part);
  CHECK(partition(m, 8, 5) == part);
}

TEST_CASE("one part, and more parts than tetrahedra") {
  const TetMesh m = cubes(1, all_molecule);
  CHECK(partition(m, 1, 1) == std::vector<int32_t>(6, 0));
  std::vector<int32_t> part = partition(m, 100, 1);
  std::sort(part.begin(), part.end());
  CHECK(part == std::vector<int32_t>{0, 1, 2, 3, 4, 5});
  CHECK(partition(TetMesh{}, 4, 1).empty());
}

TEST_CASE("no part is empty, however many are asked for, and METIS says nothing", "[slow]") {
  const int n = GENERATE(2, 9, 30);
  const TetMesh m = cubes(n, all_molecule);
  const auto tets = static_cast<int>(m.tet.size());
  const test::Outcome quiet = test::in_child([&] {
    for (const int parts : {2, 8, 37, 1000, 2000, tets / 25, tets / 20, tets / 4, tets - 1, tets}) {
      const int expected = std::clamp(parts, 1, tets);
      std::vector<size_t> size(static_cast<size_t>(expected));
      for (const int32_t p : partition(m, expected, 1)) // a child of a process with threads has one
        ++size.at(static_cast<size_t>(p));
      if (std::find(size.begin(), size.end(), size_t{0}) != size.end())
        return 1;
    }
    return 0;
  });
  CHECK(quiet.status == 0);
  CHECK(quiet.out.empty());
  CHECK(partition(m, tets / 3, 1) == partition(m, tets / 3, 5));
}
