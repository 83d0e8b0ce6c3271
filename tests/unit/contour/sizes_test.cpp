// sizes_test.cpp — leaves near given places are no larger than asked for, and layers are as thick.
#include "unit/contour/checked.hpp"
#include "unit/contour/level_steps.hpp"
#include "unit/contour/octree_forms.hpp"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;
using namespace molmesh::contour;

namespace {

struct Leaves {
  Lattice lattice;
  Octree tree;
  Leaves(const BlockGrid& grid, const Options& options)
      : lattice(grid, {}, options.meshed != Options::interior, 1),
        tree(lattice.cells,
             select_leaves(lattice, find_surface(lattice, 1),
                           refine_options(lattice, options, grid.frame.spacing, 0), options.threads)) {}
  /// Edge of the leaf, Å, and whether it meets the ball.
  double edge(int32_t leaf) const { return tree.extent(leaf) * lattice.view().spacing; }
  bool meets(int32_t leaf, const SizeBall& ball) const {
    const Vec3i low = tree.corner(leaf);
    const Vec3d from = lattice.position(low), to = lattice.position(low + tree.extent(leaf) * Vec3i{1, 1, 1});
    Vec3d nearest;
    for (int a = 0; a < 3; ++a)
      nearest[a] = std::clamp(ball.center[a], from[a], to[a]);
    return norm(nearest - ball.center) < ball.radius;
  }
};

} // namespace

TEST_CASE("leaves that meet a ball are no larger than its size, the smallest of several, and the mesh is valid") {
  const BlockGrid grid = ball_grid(0.2);
  const std::vector<SizeBall> balls = {{{5, 0, 0}, 2, 0.2}, {{0, 0, 0}, 1.5, 0.5}, {{0, 5, 0.5}, 2.5, 0.8}};
  for (const auto meshed : {Options::interior, Options::both}) {
    Options options;
    options.meshed = meshed;
    options.adapt = 0.3;
    const Leaves without(grid, options);
    options.sizes = balls;
    const Leaves with(grid, options);
    for (const SizeBall& ball : balls) {
      double most = 0, most_without = 0;
      for (int32_t leaf = 0; leaf < with.tree.size(); ++leaf)
        if (with.meets(leaf, ball))
          most = std::max(most, with.edge(leaf));
      for (int32_t leaf = 0; leaf < without.tree.size(); ++leaf)
        if (without.meets(leaf, ball))
          most_without = std::max(most_without, without.edge(leaf));
      CAPTURE(ball.size, most, most_without);
      CHECK(most <= ball.size);
      CHECK(2 * most > ball.size); // powers of two of the spacing
      CHECK(most_without > ball.size);
    }
    CHECK(most_steps(with.tree, 1) == 1);
    checked(mesh_of(grid, options));
  }
}

TEST_CASE("a large size lets cells of the surface be larger there, and not elsewhere") {
  const BlockGrid grid = ball_grid(0.2);
  Options options;
  options.adapt = 0.02;
  const Leaves without(grid, options);
  const SizeBall ball{{5, 0, 0}, 3.5, 0.9};
  options.sizes = {ball};
  const Leaves with(grid, options);
  const auto count = [&](const Leaves& leaves, double from, double to) {
    int64_t n = 0;
    for (int32_t leaf = 0; leaf < leaves.tree.size(); ++leaf) {
      const double d = norm(leaves.lattice.position(leaves.tree.corner(leaf)) - ball.center);
      n += d >= from && d < to;
    }
    return n;
  };
  CHECK(5 * count(with, 0, 2.5) < 4 * count(without, 0, 2.5));
  CHECK(double(count(with, 5, 100)) == Approx(double(count(without, 5, 100))).epsilon(0.01));
  checked(mesh_of(grid, options));
}

TEST_CASE("round leaves of each size there are as many layers of the next as asked for") {
  const BlockGrid grid = cube_grid(8, 0.25, [](Vec3d x) { return atom(x - Vec3d{0.4, 0.1, 0.2}); });
  int64_t before = 0;
  for (const int layers : {1, 2, 4}) {
    Options options;
    options.meshed = Options::both;
    options.adapt = 0.1;
    options.layers = layers;
    const Leaves leaves(grid, options);
    int64_t too_near = 0, looked_at = 0;
    for (int32_t leaf = 0; leaf < leaves.tree.size(); ++leaf) {
      const int level = leaves.tree.level[static_cast<size_t>(leaf)], extent = 1 << level;
      if (level < 2)
        continue;
      for (int f = 0; f < 6; ++f)
        for (int step = 0; step < layers; ++step) { // of half the leaf's edge
          Vec3i p = leaves.tree.corner(leaf);
          p[f / 2] += f % 2 ? extent + step * extent / 2 : -1 - step * extent / 2;
          const int32_t other = leaves.tree.find(p);
          ++looked_at;
          too_near += other >= 0 && leaves.tree.level[static_cast<size_t>(other)] < level - 1;
        }
    }
    CAPTURE(layers, looked_at);
    CHECK(too_near == 0);
    CHECK(leaves.tree.size() > before);
    before = leaves.tree.size();
    checked(mesh_of(grid, options));
  }
}
