// adjacency.hpp — faces shared by tetrahedra, and the boundary triangles that follow from them.
#pragma once
#include "geom/tet_measures.hpp"
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Face f of tetrahedron t is opposite to corner f; its number is 4 t + f. Corners counter-clockwise seen from
/// outside (when the tetrahedron is positive).
inline Tri face_points(const TetMesh& m, int64_t face) {
  const Tet& t = m.tet[static_cast<size_t>(face / 4)];
  const int f = static_cast<int>(face % 4);
  return {t[static_cast<size_t>(tet_face(f, 0))], t[static_cast<size_t>(tet_face(f, 1))],
          t[static_cast<size_t>(tet_face(f, 2))]};
}

enum : int32_t { no_face = -1, crowded_face = -2 };

/// [4 tets] The face of the neighboring tetrahedron, no_face, or crowded_face where more than two tetrahedra share
/// it. At most 2^29 tetrahedra; points in range.
std::vector<int32_t> face_neighbors(const TetMesh& m, int threads);

/// Does the triangle on this face look out of its tetrahedron? `other`: region of the neighbor, 0 for none.
/// Molecular-surface triangles point out of region 1, also where region 1 is not part of the mesh; all others with
/// a tetrahedron on one side point out of it; all others between two regions out of the lower label.
inline bool triangle_looks_out(int32_t region, int32_t other, int32_t boundary) {
  if (other != 0)
    return region < other;
  return boundary != Boundary::surface || region == Region::molecule;
}

/// Triangles anew: every face between regions and every face with one tetrahedron, ordered by tetrahedron, label 1.
void rebuild_triangles(TetMesh& m, int threads = 1);

} // namespace molmesh
