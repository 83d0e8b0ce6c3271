// bricks.hpp — the grid in bricks of 4³ blocks, each with the clusters of atoms that can matter in it.
#pragma once
#include "density/band/active_set_simd.hpp"
#include "density/field/field.hpp"
#include "grid/block_grid.hpp"
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

/// Width in blocks of the smallest cube of 8^n bricks that spans the grid from its first block.
int32_t blocks_across(const GridFrame& frame);

} // namespace molmesh::density
