// halved_topology.hpp — half the spacing, and the isosurface's topology that of the grid.
#pragma once
#include "grid/block_grid.hpp"
#include <optional>
#include <vector>

namespace molmesh::contour {

/// Cells of the grid, by their lowest corners, ascending, in which the trilinear isosurface of half, halved(grid),
/// has another topology than in the grid's cell: inside and outside join other corners, in the cell or on one of
/// its faces, or a part of theirs has no corner, or the inside has another Euler number.
std::vector<Vec3i> cells_of_other_topology(const BlockGrid& grid, const BlockGrid& half, int threads);

/// halved(grid), but with the mean of G itself in those cells, so that trilinear G is what it was there, and in
/// those beside them that then are others. None where rounding decides what joins what.
std::optional<BlockGrid> halved_alike(const BlockGrid& grid, int threads);

} // namespace molmesh::contour
