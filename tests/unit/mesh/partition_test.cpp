// partition_test.cpp — parts are even, few faces lie between them, threads do not matter.
#include "mesh/partition.hpp"
#include "meshes.hpp"
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
  for (int threads : {1, 5}) {
    int calls = 0;
    CHECK(partition(m, 8, threads, {}, [&] { ++calls; }) == part);
    CHECK(calls == 1);
  }
}

TEST_CASE("one part, and more parts than tetrahedra") {
  const TetMesh m = cubes(1, all_molecule);
  int calls = 0;
  CHECK(partition(m, 1, 1, {}, [&] { ++calls; }) == std::vector<int32_t>(6, 0));
  CHECK(calls == 1);
  for (int32_t p : partition(m, 100, 1))
    CHECK((p >= 0 && p < 6));
  CHECK(partition(TetMesh{}, 4, 1).empty());
}
