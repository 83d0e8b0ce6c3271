// band.hpp — band cells: which grid points are active, and which blocks must be known for that.
// A cell is a band cell when its corners are neither all below band_lower nor all above band_upper.
#pragma once
#include "density/block_grid.hpp"

namespace molmesh::density {

/// The grid holds G at every slot of its blocks; blocks in `inside` are above the band at every point, all others
/// below it. Returns, ascending, the blocks that are not in grid.corner and have a corner of a band cell.
std::vector<Vec3i> blocks_missing_from_band(const BlockGrid& grid, int threads);

/// Sets grid.active to the corners of all band cells, values of inactive points to their side's, and moves blocks
/// without active points to `inside` or away. No block may be missing.
void keep_band(BlockGrid& grid, int threads, int64_t& active_points);

} // namespace molmesh::density
