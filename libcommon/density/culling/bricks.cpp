// bricks.cpp — finds bricks in the list, and blocks in the grid.
#include "density/culling/bricks.hpp"
#include <algorithm>

namespace molmesh::density {

std::span<const int32_t> BrickList::clusters_at(Vec3i corner) const {
  const auto at =
      std::lower_bound(brick.begin(), brick.end(), corner, [](const Brick& a, Vec3i c) { return a.corner < c; });
  return at != brick.end() && at->corner == corner ? clusters(*at) : std::span<const int32_t>();
}

Box points_box(const GridFrame& frame, Vec3i corner, int32_t blocks) {
  const Vec3i first = 8 * corner;
  return {frame.position(first), frame.position(first + Vec3i{1, 1, 1} * (8 * blocks - 1))};
}

Vec3i first_block(const GridFrame& frame) {
  return {frame.lower.x >> 3, frame.lower.y >> 3, frame.lower.z >> 3};
}

bool in_grid(const GridFrame& frame, Vec3i block) {
  for (int a = 0; a < 3; ++a)
    if (8 * (int64_t{block[a]} + 1) <= frame.lower[a] ||
        8 * int64_t{block[a]} >= int64_t{frame.lower[a]} + frame.points[a])
      return false;
  return true;
}

int32_t blocks_across(const GridFrame& frame) {
  int32_t blocks = brick_blocks;
  const Vec3i first = first_block(frame);
  for (int a = 0; a < 3; ++a)
    while (8 * (int64_t{first[a]} + blocks) < int64_t{frame.lower[a]} + frame.points[a])
      blocks *= 2;
  return blocks;
}

} // namespace molmesh::density
