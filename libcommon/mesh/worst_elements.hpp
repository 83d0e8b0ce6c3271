// worst_elements.hpp — finds the tetrahedra whose dihedral angles are furthest beyond limits.
#pragma once
#include "mesh/quality.hpp"
#include <string>

namespace molmesh {

struct WorstTet {
  int64_t tet = -1;
  Vec3d centre;            ///< of its four points
  double min = 0, max = 0; ///< dihedral angles, degrees
};

/// At most `most` of those beyond the limits, furthest first, the first of equals first. Same result at any number
/// of threads.
std::vector<WorstTet> worst_tets(const TetMesh& m, AngleLimits limits, size_t most, int threads);

/// How many are beyond them.
int64_t count_beyond(const TetMesh& m, AngleLimits limits, int threads);

/// "24.10° to 142.32°"
std::string range_text(double min, double max);
/// "element 7 has 24.10° to 142.32°, at 1.000 2.000 3.000 Å"
std::string described(const WorstTet& t);

} // namespace molmesh
