// active_set_simd.hpp — finds the active points of a brick of 4³ blocks, the corners of band cells, by bit masks of
// the sides of points; vectorized for the best instruction set of this machine.
#pragma once
#include "density/band/point_sets_simd.hpp"

namespace molmesh::density {

/// The points of a brick that are below the band and those that are above.
struct Sides {
  FacedBits below, above;
};

/// Cells of a brick and of the layer of cells before it: cell (i, j, k) lies between points i and i + 1, and so on;
/// those with first[axis] ≤ index < end[axis] lie in the grid, -1 is the lowest that touches the brick.
struct CellRange {
  int32_t first[3], end[3];
};

/// Corners of band cells in a brick: of cells whose corners are neither all below nor all above the band. below and
/// above: the sets of the 27 bricks around it, in order of (x, y, z), the brick itself the 14th.
void band_points(const FacedBits* const* below, const FacedBits* const* above, const CellRange& cells,
                 BrickBits& active);

/// The same as far as the brick knows it alone. What lies beyond its own points counts as `beyond` has it at the
/// nearest of them.
void likely_band_points(const Sides& sides, const Sides& beyond, const CellRange& cells, BrickBits& active);

} // namespace molmesh::density
