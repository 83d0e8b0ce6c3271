// surface_cells.hpp — the fine cells that the surface crosses.
#pragma once
#include <cstdint>

namespace molmesh::contour {

struct SurfaceCell {
  uint64_t key;   ///< Morton code of the lower corner, lattice point
  float value[8]; ///< at corner c = x + 2 y + 4 z
};

} // namespace molmesh::contour
