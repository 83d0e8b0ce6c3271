// overview.hpp — what one line says of a mesh: extreme dihedral angles, volume and area of the molecule.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

struct Overview {
  double least_angle = 180, largest_angle = 0; ///< degrees, over all elements; 180 and 0 where there are none
  double volume = 0;                           ///< Å³ of the molecule: region 1 and domains
  double area = 0;                             ///< Å² of the triangles with boundary 1
};

/// Points in range, faces with area. Far quicker than measure_quality, which has distributions. Same result at any
/// number of threads.
Overview overview(const TetMesh& m, int threads);

} // namespace molmesh
