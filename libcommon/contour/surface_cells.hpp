// surface_cells.hpp — the fine cells that the surface crosses.
#pragma once
#include "contour/lattice.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::contour {

struct SurfaceCell {
  uint64_t key;   ///< Morton code of the lower corner, lattice point
  float value[8]; ///< at corner c = x + 2 y + 4 z
};

/// All of them within the lattice, ascending by key. Throws Error(bad_input) when the surface crosses a cell with
/// an inactive corner: such a grid does not hold every band cell (I2).
std::vector<SurfaceCell> surface_cells(const Lattice& lattice, int threads);

} // namespace molmesh::contour
