// quality.hpp — summarizes the shape of the tetrahedra: dihedral angles, Joe and Liu's Q, edge ratio.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Values of one measure over tetrahedra (dihedral angles: six each).
struct Distribution {
  double min = 0, max = 0, mean = 0;
  int64_t min_tet = -1, max_tet = -1; ///< where; the first of equals. -1: no values
  double low = 0, width = 0; ///< bin i counts values in [low + i width, low + (i + 1) width), ends but for rounding
  std::vector<int64_t> bin;  ///< what lies beyond either end is counted in the bin there
};

/// Degrees; the quality asked for.
struct AngleLimits {
  double min = 0, max = 180;
  /// Angles that are 45° or 90° by construction come out of rounding beside it.
  static constexpr double rounding = 1e-9;
  bool hold(double degree) const { return degree >= min - rounding && degree <= max + rounding; }
};

struct Quality {
  int64_t tets = 0, outside = 0; ///< outside: with a dihedral angle beyond the limits
  Distribution dihedral;         ///< degrees, 36 bins of 5°; negative in inverted tetrahedra
  Distribution joe_liu_q;        ///< equation 8 of the paper, 20 bins of 0.05
  Distribution eta;              ///< Joe and Liu's own, Q^(2/3), 20 bins of 0.05
  Distribution edge_ratio;       ///< longest over shortest, 20 bins of 0.5 from 1
};

struct MeshQuality {
  Quality all;
  std::vector<int32_t> region; ///< ascending
  std::vector<Quality> of;     ///< [regions]
};

/// Points in range, coordinates finite. A tetrahedron without measures (a face without area) counts with angles 0,
/// 180, and with an edge ratio of infinity where an edge has no length. Same result at any number of threads.
MeshQuality measure_quality(const TetMesh& m, int threads, AngleLimits limits = {});

} // namespace molmesh
