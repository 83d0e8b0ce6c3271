// bricks.hpp — the grid in bricks of 4³ blocks, each with the clusters of atoms that can matter in it.
#pragma once
#include "density/band/active_set_simd.hpp"
#include "density/field/field.hpp"
#include "grid/tile.hpp"
#include <span>
#include <vector>

namespace molmesh::density {

/// A cube of blocks, and its clusters as a range of BrickList::cluster.
struct Brick {
  Vec3i corner; ///< in blocks
  int64_t begin, end;
};

struct BrickList {
  std::vector<Brick> brick;    ///< ascending, corners at multiples of brick_blocks from the grid's first block
  LargeArray<int32_t> cluster; ///< of a brick: ascending
  std::span<const int32_t> clusters(const Brick& n) const {
    return std::span(cluster).subspan(static_cast<size_t>(n.begin), static_cast<size_t>(n.end - n.begin));
  }
  /// Those of the brick at `corner`; none when it has none.
  std::span<const int32_t> clusters_at(Vec3i corner) const;
};

/// Box of the points of a cube of blocks, Å, from block `corner` (in blocks).
Box points_box(const GridFrame& frame, Vec3i corner, int32_t blocks);
/// The first block (in blocks) of the grid, and whether a block has a point of it.
Vec3i first_block(const GridFrame& frame);
bool in_grid(const GridFrame& frame, Vec3i block);

/// Blocks begin ≤ index < end.
struct BlockRange {
  Vec3i begin, end;
  /// Whether the cube of blocks from `corner` on has some of them.
  bool meets(Vec3i corner, int32_t blocks) const {
    for (int a = 0; a < 3; ++a)
      if (int64_t{corner[a]} + blocks <= begin[a] || corner[a] >= end[a])
        return false;
    return true;
  }
  bool empty() const { return begin.x >= end.x || begin.y >= end.y || begin.z >= end.z; }
};
/// Those of a grid that lie in a slab of it, and with them as many `more` on both sides of the slab.
BlockRange blocks_of(const GridFrame& frame, const Slab& slab, int32_t more = 0);

/// Width in blocks of the smallest cube of 8^n bricks that spans the grid from its first block.
int32_t blocks_across(const GridFrame& frame);

} // namespace molmesh::density
