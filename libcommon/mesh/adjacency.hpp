// adjacency.hpp — finds the faces that tetrahedra share, and the boundary triangles that follow from them.
#pragma once
#include "geom/tet_measures.hpp"
#include "mesh/region_order.hpp"
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Face f of tetrahedron t is opposite to corner f; its number is 4 t + f. Corners counter-clockwise seen from
/// outside (when the tetrahedron is positive).
inline Tri face_points(const TetMesh& m, int64_t face) {
  const Tet& t = m.tet[face / 4];
  const int f = static_cast<int>(face % 4);
  return {t[tet_face(f, 0)], t[tet_face(f, 1)], t[tet_face(f, 2)]};
}

enum : int32_t { no_face = -1, crowded_face = -2 };

/// [4 tets] The face of the neighboring tetrahedron, no_face, or crowded_face where more than two tetrahedra share
/// it. At most 2^29 tetrahedra; points in range.
LargeArray<int32_t> face_neighbors(const TetMesh& m, int threads);

/// Region on the other side of the face; 0 where no tetrahedron is, or several are. across: face_neighbors.
inline int32_t region_across(const TetMesh& m, const LargeArray<int32_t>& across, int64_t face) {
  const int32_t f = across[face];
  return f < 0 ? 0 : m.region[static_cast<size_t>(f) / 4];
}

/// Faces towards another region or nothing, ascending; those between two regions from both of their sides.
/// Faces of more than two tetrahedra are left out.
std::vector<int64_t> boundary_faces(const TetMesh& m, const LargeArray<int32_t>& across, int threads);

/// Two triangles on the same points: do they go round the same way?
inline bool same_turn(const Tri& a, const Tri& b) {
  const size_t shift = a[0] == b[0] ? 0 : a[0] == b[1] ? 1 : 2;
  return a[1] == b[(shift + 1) % 3];
}

/// Does the triangle on this face look out of its tetrahedron? `other`: region of the neighbor, 0 for none.
/// Molecular-surface triangles point out of region 1 and the domains, also where region 1 is not part of the mesh;
/// all others with a tetrahedron on one side point out of it; all others between two regions out of the first.
inline bool triangle_looks_out(const RegionOrder& order, int32_t region, int32_t other, int32_t boundary) {
  if (other != 0)
    return order.is_first(region, other);
  return boundary != Boundary::surface || order.is_inside(region);
}

/// Triangles anew: every face between regions and every face with one tetrahedron, ordered by tetrahedron, label 1.
void rebuild_triangles(TetMesh& m, int threads = 1);

/// Rebuilt triangles of a mesh of several regions: those with one tetrahedron in an outermost plane of x, y or z
/// get the box's labels and point out of it. Planes are exact.
void label_walls(TetMesh& m, int threads = 1);

} // namespace molmesh
