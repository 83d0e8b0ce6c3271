// cavity_walls_test.cpp — which triangles face closed cavities, against the regions beside them.
#include "mesh/cavity_walls.hpp"
#include "unit/mesh/meshes.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

namespace {

int64_t walls(const TetMesh& m) {
  const std::vector<uint8_t> wall = cavity_walls(m);
  return std::count(wall.begin(), wall.end(), 1);
}

} // namespace

TEST_CASE("cavity walls are the triangles beside region 3, with the cavity in the mesh or not") {
  // A block with two cavities of one and of two cubes, and a smaller block beside it.
  const TetMesh both = testing::cubes(9, [](Vec3i p) {
    if (p == Vec3i{2, 2, 2} || p == Vec3i{4, 4, 4} || p == Vec3i{4, 4, 5})
      return 3;
    const bool large = std::min({p.x, p.y, p.z}) >= 1 && std::max({p.x, p.y, p.z}) <= 6;
    return large || p == Vec3i{8, 4, 4} ? 1 : 2;
  });
  const LargeArray<int32_t> across = face_neighbors(both, 1);
  int64_t beside = 0;
  for (int64_t f = 0; f < static_cast<int64_t>(across.size()); ++f)
    beside += both.region[f / 4] == 1 && region_across(both, across, f) == 3;
  CHECK(beside == 2 * (6 + 10));
  CHECK(walls(both) == beside);
  const TetMesh inside = testing::extract(both, [](int32_t region) { return region == 1; });
  CHECK(walls(inside) == beside);
  const std::vector<uint8_t> wall = cavity_walls(both);
  for (size_t t = 0; t < both.tri.size(); ++t)
    if (wall[t]) {
      const Vec3d c = cell_centroid(both, both.tet.size() + t);
      CHECK((std::min({c.x, c.y, c.z}) >= 2 && std::max({c.x, c.y, c.z}) <= 6));
    }
}

TEST_CASE("a surface that the box cuts has no cavity walls, nor has a mesh without cavities") {
  // A pit in a molecule that fills the box: its surface, closed by the wall, would enclose less than nothing.
  const TetMesh pit = testing::cubes(4, [](Vec3i p) { return p.x == 0 && p.y == 1 && p.z == 1 ? 2 : 1; });
  CHECK(walls(pit) == 0);
  CHECK(walls(testing::extract(pit, [](int32_t region) { return region == 1; })) == 0);
  CHECK(walls(testing::cubes(4, [](Vec3i p) { return p.x > 0 && p.x < 3 && p.y == 1 && p.z == 1 ? 1 : 2; })) == 0);
}
