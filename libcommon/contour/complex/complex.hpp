// complex.hpp — the octree's leaves as a face-to-face complex of convex cells, with a dual vertex in each.
// Section 4.1 of Liao et al. 2013. Every mesh is the dual of this complex; see elements.hpp. Host and device.
//
// The life of a grid point:
//  1. numbered: one id for each corner of leaves, in the order of the octree's curve (numbering_items.hpp);
//  2. measured: its value, its nearest sample, its distance to the surface (KeepDistance in distance_items.hpp);
//  3. kept at distance: moved along the gradient where it is too near the surface (KeepDistance);
//  4. restored: put back where an element hangs on it that would have no positive volume (ComplexPasses);
//  5. relaxed: moved, as all vertices may be, to where its worst element is best (relaxation/), and, on the
//  surface,
//     nearer to the isosurface (surface_distance/). From here on ElementArrays::position has its place;
//  6. renumbered: points of the mesh are those in use, in the order of their first use (assembly/).
#pragma once
#include "base/large_array.hpp"
#include "contour/octree/lattice.hpp"
#include "contour/octree/octree.hpp"
#include "contour/surface/ambiguous_cell.hpp"
#include "contour/surface/split_cell.hpp"
#include "contour/surface/surface_cell.hpp"
#include <cstdint>

namespace molmesh::contour {

/// The complex as plain arrays: what its passes read and write. Members as in ComplexArrays.
struct ComplexView {
  LatticeView lattice;
  OctreeView tree;
  const SurfaceCell* cells = nullptr;
  const SurfaceSample* samples = nullptr;
  int32_t surface_cells = 0;
  int32_t grid_vertices = 0, dual0 = 0;
  int32_t pieces = 0; ///< vertices after the leaves' duals
  /// Its elements are made at the surface alone, which is to move, and may be flat (unmeshed_weight); crossed:
  /// neither's.
  Side unmeshed = Side::crossed;

  Side* side = nullptr;
  int32_t *first_cell = nullptr, *grid_vertex = nullptr, *beside = nullptr, *split = nullptr, *split_leaf = nullptr;
  Vec3d* position = nullptr;
  float* value = nullptr;
  Vec3i* point = nullptr;
  float *distance = nullptr, *estimate = nullptr;
  uint8_t* has_moved = nullptr;
  int32_t* nearest = nullptr;
  uint8_t* least_level = nullptr;
  uint16_t* face_points = nullptr;

  MOLMESH_HD int32_t vertices() const { return dual0 + tree.leaves + pieces; }
  MOLMESH_HD bool inside(int32_t vertex) const { return value[vertex] > lattice.isovalue; }
  /// Of a grid point: whether it lies on a wall of the lattice.
  MOLMESH_HD bool at_wall(int32_t vertex) const {
    const Vec3i p = point[vertex], end = lattice.cells;
    return p.x == 0 || p.y == 0 || p.z == 0 || p.x == end.x || p.y == end.y || p.z == end.z;
  }
  MOLMESH_HD bool is_split(int32_t leaf) const { return split[leaf] >= 0; }
  MOLMESH_HD int32_t dual(int32_t leaf) const { return dual0 + leaf; }
  MOLMESH_HD bool moved(int32_t vertex) const { return vertex < grid_vertices && has_moved[vertex]; }
  MOLMESH_HD int32_t corner_vertex(int32_t leaf, int corner) const {
    return grid_vertex[int64_t{8} * leaf + corner];
  }
  MOLMESH_HD int32_t neighbour(int32_t leaf, int face) const { return beside[int64_t{6} * leaf + face]; }
  MOLMESH_HD int32_t leaf_of(int32_t vertex) const {
    const int32_t leaf = vertex - dual0, piece = leaf - tree.leaves;
    return leaf < 0 || piece >= pieces ? -1 : piece < 0 ? leaf : split_leaf[piece];
  }
  /// Surface cells within a leaf: first_cell[leaf] up to here.
  MOLMESH_HD int32_t end_cell(int32_t leaf) const {
    const uint64_t end = tree.key[leaf] + (uint64_t{1} << 3 * tree.level[leaf]);
    int32_t c = first_cell[leaf];
    while (c < surface_cells && cells[c].key < end)
      ++c;
    return c;
  }
  MOLMESH_HD CellTopology topology(int32_t leaf) const {
    const SurfaceCell& cell = cells[first_cell[leaf]];
    double v[8];
    for (int c = 0; c < 8; ++c)
      v[c] = over_isovalue(cell.value[c], lattice.isovalue);
    return cell_topology(v);
  }
  MOLMESH_HD int32_t piece_dual(int32_t leaf, const SplitCell& s, const Patch& p) const {
    return split[leaf] + 1 + (p.piece < 0 ? s.pieces : p.piece);
  }
  /// Of the piece of a split leaf behind face f; off: the triangle's corner off the diagonal, -1 for a square.
  MOLMESH_HD int32_t piece_dual(int32_t leaf, const SplitCell& s, int f, int off) const {
    for (const Patch& p : s.patch)
      if (p.face == f && (off < 0 || p.corner[1] == off))
        return piece_dual(leaf, s, p);
    return -1; // every face has its patches
  }
};

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

} // namespace molmesh::contour
