// angles.hpp — dihedral angles of a whole mesh.
#pragma once
#include "optimize/mesh/dynamic_mesh.hpp"
#include <string>

namespace molmesh::optimize {

struct Angles {
  double min = 180, max = 0;           ///< degrees
  int64_t below_25 = 0, above_140 = 0; ///< elements
};

/// Elements have their qualities. Same result for any number of threads.
Angles measure_angles(const DynamicMesh& mesh, int threads);

/// "24.1° to 142.3°, 2 elements under 25°, 1 over 140°"
std::string text(const Angles& a);

} // namespace molmesh::optimize
