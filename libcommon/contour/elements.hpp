// elements.hpp — tetrahedra round the edges of the complex. Section 4.1 and 4.2 of Liao et al. 2013.
//
// Between two cells stands a face, a convex polygon. Each of its edges and the two cells' dual vertices make one
// tetrahedron; all of these have positive volume exactly when the segment between the dual vertices pierces the
// face. Where it does not, a point of the face is put between them: then they always have. The tetrahedra round a
// sign-change edge are replaced by pyramids from either end over the ring of dual vertices, both split by the same
// diagonals; where no diagonal leaves positive volumes, the edge's crossing point is joined with the ring. So every
// mesh is valid by construction: what is chosen is only how good it is.
#pragma once
#include "contour/complex.hpp"
#include "mesh/tet_mesh.hpp"
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::contour {

/// Elements before regions are told apart.
struct Elements {
  std::vector<Tet> tet; ///< positive; tet[0] is a vertex of the complex on the element's side
  std::vector<Tri> tri; ///< out of the molecule, or out of the box
  std::vector<std::array<int32_t, 2>>
      tri_sides;                 ///< [tris] vertices of the complex behind and in front; equal on a wall
  std::vector<int32_t> boundary; ///< [tris] Boundary
  std::vector<Vec3d> position;   ///< all vertices: those of the complex, then face, wall and edge points
  /// Vertices of the complex that elements without positive volume, on either side, hang on, ascending: where grid
  /// points have moved the cells are no boxes.
  std::vector<int32_t> spoiled;
  int64_t face_points = 0, edge_points = 0;
};

/// What Elements::spoiled would be, without making elements.
std::vector<int32_t> find_spoiled(const Complex& complex, int threads);
/// The same of the elements that hang on these leaves' dual vertices or corners and of some around them: what is
/// left to look at after Complex::restore.
std::vector<int32_t> spoiled_at(const Complex& complex, const std::vector<int32_t>& leaves, int threads);

/// inside, outside: sides to make elements on. The order follows the octree's curve, whatever the threads.
Elements make_elements(const Complex& complex, bool inside, bool outside, int threads);

} // namespace molmesh::contour
