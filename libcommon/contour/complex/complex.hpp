// complex.hpp — the octree's leaves as a face-to-face complex of convex cells, with a dual vertex in each.
// Section 4.1 of Liao et al. 2013. Every mesh is the dual of this complex; see elements.hpp.
#pragma once
#include "base/large_array.hpp"
#include "contour/complex/complex_view.hpp"
#include <cstdint>

namespace molmesh::contour {

/// Everything known per leaf and per vertex of the complex, in the arrays of a Memory: HostMemory, or a device's.
/// Vertex ids: grid points first, then one dual vertex per leaf (dual0 + leaf), then for each split cell its centre
/// and the dual vertices of its pieces.
template <class Memory>
struct ComplexArrays {
  template <class T>
  using Array = typename Memory::template Array<T>;

  Array<Side> side;           ///< [leaves]
  Array<int32_t> grid_vertex; ///< [8·leaves] vertex id of each corner
  Array<int32_t> beside;      ///< [6·leaves] NearLeaves::neighbour across each face
  Array<int32_t> first_cell;  ///< [leaves] first surface cell within, -1 none
  Array<int32_t> split;       ///< [leaves] first vertex id of a split cell (its centre), -1: not split
  Array<int32_t> split_leaf;  ///< [vertices after the leaves' duals]
  Array<Vec3d> position;      ///< [vertices] Å
  Array<float> value;         ///< [vertices] G at grid points and split centres; isovalue elsewhere
  Array<Vec3i> point;         ///< [grid vertices] lattice point
  /// [grid vertices] estimated distance to the surface, Å, positive inside, 0: unknown, or no surface cell's; and
  /// what it was before the point moved
  Array<float> distance, estimate;
  Array<uint8_t> has_moved;   ///< [grid vertices]
  Array<uint8_t> least_level; ///< [grid vertices] of the leaves with the point as a corner
  Array<int32_t> nearest;     ///< [grid vertices] nearest sample in the leaves around, -1: none
  /// [leaves] bit 2f, of a halved face 2f + 1 too: the leaf's own face f gets a point, as the check of faces found
  Array<uint16_t> face_points;
  ComplexView view; ///< points to them, and to the lattice, octree and surface that the caller keeps
};

/// On the host.
struct HostMemory {
  template <class T>
  using Array = LargeArray<T>;
};
using Complex = ComplexArrays<HostMemory>;

/// As detail::LatticeClasses says.
LargeArray<uint8_t> lattice_classes(const Complex& complex, int threads);

} // namespace molmesh::contour
