// octree_test.cpp — leaves beside each other, and dual vertices off the faces of smaller ones.
#include "contour/complex/dual_contouring.hpp"
#include "unit/contour/checked.hpp"
#include "unit/contour/level_steps.hpp"
#include "unit/contour/sample_grid.hpp"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;
using namespace molmesh::contour;

namespace {

/// Two atoms that touch: fine cells in the crease, large ones beside it.
BlockGrid crease() {
  return cube_grid(8, 0.2, [](Vec3d x) { return atom(x - Vec3d{2.9, 0.3, 0}) + atom(x + Vec3d{2.9, 0, 0.2}); });
}

struct Leaves {
  Lattice lattice;
  Surface surface;
  Octree tree;
  Leaves(const BlockGrid& grid, double adapt)
      : lattice(grid, {}, true, 1), surface(find_surface(lattice, 1)),
        tree(lattice.cells, select_leaves(lattice, surface, {adapt, true, true}, 1)) {}
};

} // namespace

TEST_CASE("leaves differ by one level across faces, by two across edges, and the mesh is valid") {
  const BlockGrid grid = crease();
  const Leaves leaves(grid, 0.3);
  CHECK(most_steps(leaves.tree, 1) == 1);
  CHECK(most_steps(leaves.tree, 2) == 2);
  Options options;
  options.meshed = Options::both;
  options.adapt = 0.3;
  checked(mesh_of(grid, options));
}

TEST_CASE("every cell is found in its leaf, however large, and so it is where others were looked up before") {
  const BlockGrid grid = crease();
  const Leaves leaves(grid, 0.3);
  const OctreeView& tree = leaves.tree.view();
  NearLeaves near(tree);
  int large = 0;
  for (int32_t leaf = 0; leaf < tree.leaves; ++leaf) {
    const Vec3i corner = tree.corner(leaf);
    const int32_t extent = tree.extent(leaf);
    large += extent >= 16;
    for (const int32_t step : {0, extent / 2, extent - 1}) {
      const Vec3i p = corner + Vec3i{step, extent - 1 - step, step};
      CHECK(tree.find(p) == leaf);
      CHECK(near.find(p) == leaf);
    }
    CHECK(near.starting_at(tree.key[leaf]) == leaf);
    for (int f = 0; f < 6; ++f) {
      Vec3i beside = corner;
      beside[f / 2] += f % 2 ? extent : -1;
      CHECK(near.neighbour(leaf, f) == tree.find(beside));
    }
  }
  CHECK(large > 0);
}

TEST_CASE("merged cells' dual vertices keep off faces with smaller cells behind") {
  const BlockGrid grid = crease();
  const Leaves leaves(grid, 0.3);
  const Dual dual =
      make_dual({leaves.lattice, leaves.tree, leaves.surface, Side::crossed, 1}, [](const std::string&) {});
  const ComplexView& c = dual.complex.view;
  NearLeaves near(c.tree);
  int looked_at = 0;
  double nearest = 1, nearest_any = 1;
  for (int32_t leaf = 0; leaf < c.tree.leaves; ++leaf) {
    const int32_t extent = c.tree.extent(leaf);
    if (extent < 2 || c.side[leaf] != Side::crossed)
      continue;
    const Vec3i corner = c.tree.corner(leaf);
    const Vec3d low = c.lattice.position(corner),
                size = c.lattice.position(corner + Vec3i{extent, extent, extent}) - low;
    for (int f = 0; f < 6; ++f) {
      const double share = (c.position[c.dual(leaf)][f / 2] - low[f / 2]) / size[f / 2];
      const double from_face = f % 2 ? 1 - share : share;
      nearest_any = std::min(nearest_any, from_face * extent);
      const int32_t other = near.neighbour(leaf, f);
      if (other < 0 || c.tree.level[other] >= c.tree.level[leaf])
        continue;
      ++looked_at;
      nearest = std::min(nearest, from_face);
    }
  }
  CHECK(looked_at > 100);
  CHECK(nearest > 0.25 - 1e-9);
  CHECK(nearest_any > 0.3 - 1e-9);
  CHECK(nearest_any < 0.5); // where no smaller cells are behind it may come nearer
}
