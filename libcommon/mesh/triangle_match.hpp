// triangle_match.hpp — tells which triangles of a mesh lie on which faces of its tetrahedra.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

struct TriangleMatch {
  enum Kind : uint8_t {
    good,
    missing, ///< a face without a triangle
    stray,   ///< a triangle on no face between regions and no face with one tetrahedron
    twice,   ///< on a face, or on three points, that another triangle has
    turned,  ///< pointing the wrong way (triangle_looks_out)
  };
  std::vector<int64_t> owner;     ///< faces that ask for a triangle; between two regions that of the lower label
  std::vector<uint8_t> kind;      ///< [owner, then triangles] Kind
  std::vector<uint8_t> one_sided; ///< [triangles] on a face with one tetrahedron
};

/// across: face_neighbors; boundary: boundary_faces. Same result at any number of threads.
TriangleMatch match_triangles(const TetMesh& m, const LargeArray<int32_t>& across,
                              const std::vector<int64_t>& boundary, int threads);

} // namespace molmesh
