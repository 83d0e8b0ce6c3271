// halved_grid.hpp — the same isosurface, with the same topology, on a grid of half the spacing.
#pragma once
#include "grid/block_grid.hpp"
#include <optional>
#include <vector>

namespace molmesh::contour {

/// Grid point p becomes 2p and keeps its value, its side and whether it is active; a point between has the mean of
/// log G of the 2, 4 or 8 points around it, as a trilinear log G has it, and is active where they all are. Cells of
/// eight active corners, and those alone, are so eight such cells: every cell that the surface crosses still is
/// known (I2), and no point between leaves the side of points that agree. linear: points of the halved grid,
/// ascending, that have the mean of G itself.
BlockGrid halved(const BlockGrid& grid, int threads, const std::vector<Vec3i>& linear = {});

/// Cells of the grid, by their lowest corners, ascending, in which the trilinear isosurface of half, halved(grid),
/// has another topology than in the grid's cell: inside and outside join other corners, in the cell or on one of
/// its faces, or a component has no corner, or the inside has another Euler number.
std::vector<Vec3i> cells_of_other_topology(const BlockGrid& grid, const BlockGrid& half, int threads);

/// halved(grid), but with the mean of G itself in those cells, so that trilinear G is what it was there, and in
/// those beside them that then are others. None where rounding decides what joins what.
std::optional<BlockGrid> halved_alike(const BlockGrid& grid, int threads);

} // namespace molmesh::contour
