// near_bricks.hpp — the bricks of a grid, each with the places that may matter in it.
#pragma once
#include "density/culling/bricks.hpp"
#include "distance/union_of_balls.hpp"
#include "grid/block_grid.hpp"
#include <vector>

namespace molmesh::distance {

/// A cube of 4³ blocks.
struct NearBrick {
  Vec3i corner;              ///< in blocks
  std::vector<int32_t> near; ///< ascending
};

/// The bricks with blocks in `range`, of the grid, that balls meet, with the numbers of these balls; a brick
/// reaches one spacing beyond its own points. Ascending by corner, the same for any number of threads; nothing is
/// dense over the grid.
std::vector<NearBrick> bricks_near(const std::vector<Ball>& balls, const GridFrame& frame,
                                   const density::BlockRange& range, int threads);

} // namespace molmesh::distance
