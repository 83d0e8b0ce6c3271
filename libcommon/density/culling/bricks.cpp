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

BlockRange blocks_of(const GridFrame& frame, const Slab& slab, int32_t more) {
  BlockRange r{first_block(frame), {}};
  for (int a = 0; a < 3; ++a)
    r.end[a] = static_cast<int32_t>((int64_t{frame.lower[a]} + frame.points[a] + 7) >> 3);
  const int a = slab.axis;
  if (slab.begin >= slab.end) {
    r.end[a] = r.begin[a];
    return r;
  }
  r.begin[a] = std::max(r.begin[a], (slab.begin >> 3) - more);
  r.end[a] = std::min(r.end[a], ((slab.end + 7) >> 3) + more);
  return r;
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
