// extras.hpp — what a .vdb file may say besides FieldInfo (VDBv1.md, optional metadata).
#pragma once
#include "grid/tail.hpp"
#include "grid/tile.hpp"
#include <string>

namespace molmesh::formats {

struct VdbExtras {
  Tail tail;                        ///< of the field beyond the band
  double resampling_error = 0;      ///< measured, |ΔG| / max(1, G); 0: no piece of it was resampled
  std::string surface = "gaussian"; ///< that of a sum of Gaussians, else another one's name
  double probe = 0;                 ///< Å, of surfaces that have a probe
  Tile tile;                        ///< the part of the grid that the file holds
  int64_t tile_digest = 0;          ///< of all that the values depend on: tiles with another one are of another run
};

} // namespace molmesh::formats
