// triangle_sides.hpp — finds the tetrahedra on both sides of every triangle, and the faces that tetrahedra share.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

struct TriangleSides {
  LargeArray<int32_t> across; ///< as face_neighbors (adjacency.hpp)
  /// [triangles] the faces (adjacency.hpp) on the same points, the lower first; -1: none
  std::vector<std::array<int32_t, 2>> face;
};

/// As face_neighbors, with the triangles in the same pass. Same result at any number of threads.
TriangleSides triangle_sides(const TetMesh& m, int threads);

} // namespace molmesh
