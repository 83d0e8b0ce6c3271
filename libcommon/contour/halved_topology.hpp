// halved_topology.hpp — whether the isosurface of a grid with half the spacing is the grid's own.
#pragma once
#include "density/block_grid.hpp"

namespace molmesh::contour {

/// Both isosurfaces are trilinear, G's in the grid's cells and in those of half = halved(grid); where more than one
/// sheet may lie in a cell they may differ, since the values between are means of log G. True when in each cell of
/// the grid, and on each of its faces, inside and outside join the same corners, and nothing is apart from all of
/// them: the surfaces are the same, cell by cell, but for tunnels within one.
bool halving_keeps_topology(const BlockGrid& grid, const BlockGrid& half, int threads);

} // namespace molmesh::contour
