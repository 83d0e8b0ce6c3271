// halved_grid.hpp — the same isosurface on a grid of half the spacing.
#pragma once
#include "grid/block_grid.hpp"
#include <vector>

namespace molmesh::contour {

/// Grid point p becomes 2p and keeps its value, its side and whether it is active; a point between has the mean of
/// log G of the 2, 4 or 8 points around it, as a trilinear log G has it, and is active where they all are. Cells of
/// eight active corners, and those alone, are so eight such cells: every cell that the surface crosses still is
/// known (I2), and no point between leaves the side of points that agree. linear: points of the halved grid,
/// ascending, that have the mean of G itself.
BlockGrid halved(const BlockGrid& grid, int threads, const std::vector<Vec3i>& linear = {});

} // namespace molmesh::contour
