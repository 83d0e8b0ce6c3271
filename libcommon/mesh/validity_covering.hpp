// validity_covering.hpp — checks that tetrahedra cover space once on the inner side of a mesh's skin and not at all
// on the outer. Positive tetrahedra that match face to face may still overlap, or have hanging nodes.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

struct Covering {
  int64_t wrong = 0; ///< edge-connected pieces of the skin that fail the test
  int64_t face = -1; ///< where the first of them fails, as adjacency.hpp numbers faces
};

/// skin: the faces with one tetrahedron, ascending; a closed surface, all tetrahedra positive. Each piece is looked
/// at where its largest triangle is, on both sides, as near as 1e-4 of its tetrahedron's height: exact, and enough
/// where no two triangles of the skin cross (crossing.hpp). Same result at any number of threads.
Covering check_covering(const TetMesh& m, const std::vector<int64_t>& skin, int threads);

} // namespace molmesh
