// worst.hpp — the tetrahedra whose dihedral angles are furthest beyond limits.
#pragma once
#include "mesh/quality.hpp"

namespace molmesh {

struct WorstTet {
  int64_t tet = -1;
  Vec3d centre;            ///< of its four points
  double min = 0, max = 0; ///< dihedral angles, degrees
};

/// At most `most` of those beyond the limits, furthest first, the first of equals first. Same result at any number
/// of threads.
std::vector<WorstTet> worst_tets(const TetMesh& m, AngleLimits limits, size_t most, int threads);

} // namespace molmesh
