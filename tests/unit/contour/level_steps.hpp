// level_steps.hpp — how much leaves of an octree that touch differ in level.
#pragma once
#include "contour/octree/octree.hpp"
#include <algorithm>
#include <cstdlib>

namespace molmesh::test {

/// The largest difference of level of a leaf and one that touches it in `axes` axes' direction, both ways on each.
inline int most_steps(const contour::Octree& tree, int axes) {
  int most = 0;
  for (int32_t leaf = 0; leaf < tree.size(); ++leaf)
    for (int n = 0; n < 27; ++n) {
      const Vec3i step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      if (std::abs(step.x) + std::abs(step.y) + std::abs(step.z) != axes)
        continue;
      Vec3i p = tree.corner(leaf);
      for (int a = 0; a < 3; ++a)
        p[a] += step[a] > 0 ? tree.extent(leaf) : step[a];
      if (const int32_t other = tree.find(p); other >= 0)
        most = std::max(most, std::abs(int(tree.level[other]) - int(tree.level[leaf])));
    }
  return most;
}

} // namespace molmesh::test
