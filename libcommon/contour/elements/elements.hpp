// elements.hpp — tetrahedra round the edges of the complex. Sections 4.1 and 4.2 of Liao et al. 2013.
//
// Minimal edges of the octree are the edges of the complex. Between two cells stands a face, a convex polygon. Each
// of its edges and the two cells' dual vertices make one tetrahedron: those of all faces round an interior edge are
// the paper's pyramid or diamond, already split (interior_edges.hpp). All have positive volume exactly when the
// segment between the dual vertices pierces the face. Where it does not, a point of the face is put between them:
// then they always have. The tetrahedra round a sign-change edge are replaced by pyramids from either end over the
// ring of dual vertices, both split by the same diagonals; where no diagonal leaves positive volumes, or better
// ones than that, the edge's crossing point is joined with the ring (sign_change_edges.hpp). So every mesh is valid
// by construction: what is chosen is only how good it is.
//
// The paper's four groups of edges, which keep threads of neighbouring leaves apart, have no counterpart: each face
// belongs to one leaf, and the faces at a sign-change edge are brought together by sorting. Threads share nothing
// that they write, and the order does not depend on them.
#pragma once
#include "contour/complex/complex.hpp"
#include "mesh/tet_mesh.hpp"
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::contour {

/// Elements as plain arrays. Members as in ElementArrays. Host and device.
struct ElementsView {
  const Tet* tet = nullptr;
  int64_t tets = 0;
  const Tri* tri = nullptr;
  const std::array<int32_t, 2>* tri_sides = nullptr;
  const int32_t* boundary = nullptr;
  int64_t tris = 0;
  Vec3d* position = nullptr;
  int64_t positions = 0;
};

/// Elements before regions are told apart, in the arrays of a Memory.
template <class Memory>
struct ElementArrays {
  template <class T>
  using Array = typename Memory::template Array<T>;

  Array<Tet> tet;                          ///< positive; tet[0] is a vertex of the complex on the element's side
  Array<Tri> tri;                          ///< out of the molecule, or out of the box
  Array<std::array<int32_t, 2>> tri_sides; ///< [tris] vertices of the complex behind and in front; equal on a wall
  Array<int32_t> boundary;                 ///< [tris] Boundary
  Array<Vec3d> position;                   ///< all vertices: those of the complex, then face, wall and edge points
  int64_t face_points = 0, edge_points = 0;

  ElementsView view() const {
    return {tet.data(),
            static_cast<int64_t>(tet.size()),
            tri.data(),
            tri_sides.data(),
            boundary.data(),
            static_cast<int64_t>(tri.size()),
            const_cast<Vec3d*>(position.data()),
            static_cast<int64_t>(position.size())};
  }
};
using Elements = ElementArrays<HostMemory>;

/// Vertices of the complex that elements without positive volume, on either side, would hang on, ascending: where
/// grid points have moved the cells are no boxes. Of the leaves' faces, and of the rings of edges with both ends
/// among `ends`, ascending, or at split cells' centres (null: of all edges).
LargeArray<int32_t> spoiled_of(const ComplexView& complex, const LargeArray<int32_t>& leaves,
                               const LargeArray<int32_t>* ends, int threads);

/// Of both sides. The order follows the octree's curve, whatever the threads. Positive where nothing is spoiled.
Elements make_elements(const ComplexView& complex, int threads);

} // namespace molmesh::contour
