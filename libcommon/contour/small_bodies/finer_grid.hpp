// finer_grid.hpp — where the grid's cells are too large for its bodies, a grid with smaller ones.
#pragma once
#include "contour/options.hpp"
#include "grid/block_grid.hpp"
#include <optional>

namespace molmesh::contour {

struct FinerGrid {
  std::optional<BlockGrid> grid; ///< none: the cells of the grid itself
  int halvings = 0;              ///< of the spacing, at most two
};

/// Chords between points a spacing h apart cut some 0.4 h²/r² off a ball of radius r, more than I8 allows up to
/// some 5 h. While they would the spacing is halved (halved_grid.hpp), but never
/// - to more than a million cells in the grid, or inside, where they are to be uniform,
/// - on grids of many points, unless small bodies alone have them,
/// - where a wall cuts the surface, or the box would have too many of the halved spacings,
/// - where rounding would change the topology, which stays that of trilinear G (I7; halved_grid.hpp), but in
///   the cells at a wall that takes the place of a grid plane: of the halved grid another plane goes.
FinerGrid finer_grid(const BlockGrid& grid, const Options& options);

} // namespace molmesh::contour
