// complex_view.hpp — contour::Complex as plain arrays: what its passes read and write. Host and device.
#pragma once
#include "contour/octree/lattice.hpp"
#include "contour/octree/octree.hpp"
#include "contour/surface/cube.hpp"
#include "contour/surface/split_cell.hpp"
#include "contour/surface/surface_sample.hpp"

namespace molmesh::contour {

/// Members as in Complex.
struct ComplexView {
  LatticeView lattice;
  OctreeView tree;
  const SurfaceCell* cells = nullptr;
  const SurfaceSample* samples = nullptr;
  int32_t surface_cells = 0;
  int32_t grid_vertices = 0, dual0 = 0;
  int32_t pieces = 0; ///< vertices after the leaves' duals
  /// Its elements are made at the surface alone, which is to move, and may be flat (unasked_weight); crossed:
  /// neither's.
  Side unasked = Side::crossed;

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

  HD int32_t vertices() const { return dual0 + tree.leaves + pieces; }
  HD bool inside(int32_t vertex) const { return value[vertex] > lattice.isovalue; }
  /// Of a grid point: whether it lies on a wall of the lattice.
  HD bool at_wall(int32_t vertex) const {
    const Vec3i p = point[vertex], end = lattice.cells;
    return p.x == 0 || p.y == 0 || p.z == 0 || p.x == end.x || p.y == end.y || p.z == end.z;
  }
  HD bool is_split(int32_t leaf) const { return split[leaf] >= 0; }
  HD int32_t dual(int32_t leaf) const { return dual0 + leaf; }
  HD bool moved(int32_t vertex) const { return vertex < grid_vertices && has_moved[vertex]; }
  HD int32_t corner_vertex(int32_t leaf, int corner) const { return grid_vertex[int64_t{8} * leaf + corner]; }
  HD int32_t neighbour(int32_t leaf, int face) const { return beside[int64_t{6} * leaf + face]; }
  HD int32_t leaf_of(int32_t vertex) const {
    const int32_t leaf = vertex - dual0, piece = leaf - tree.leaves;
    return leaf < 0 || piece >= pieces ? -1 : piece < 0 ? leaf : split_leaf[piece];
  }
  /// Surface cells within a leaf: first_cell[leaf] up to here.
  HD int32_t end_cell(int32_t leaf) const {
    const uint64_t end = tree.key[leaf] + (uint64_t{1} << 3 * tree.level[leaf]);
    int32_t c = first_cell[leaf];
    while (c < surface_cells && cells[c].key < end)
      ++c;
    return c;
  }
  HD CellTopology topology(int32_t leaf) const {
    const SurfaceCell& cell = cells[first_cell[leaf]];
    double v[8];
    for (int c = 0; c < 8; ++c)
      v[c] = over_isovalue(cell.value[c], lattice.isovalue);
    return cell_topology(v);
  }
  HD int32_t piece_dual(int32_t leaf, const SplitCell& s, const Patch& p) const {
    return split[leaf] + 1 + (p.piece < 0 ? s.pieces : p.piece);
  }
  /// Of the piece of a split leaf behind face f; off: the triangle's corner off the diagonal, -1 for a square.
  HD int32_t piece_dual(int32_t leaf, const SplitCell& s, int f, int off) const {
    for (const Patch& p : s.patch)
      if (p.face == f && (off < 0 || p.corner[1] == off))
        return piece_dual(leaf, s, p);
    return -1; // every face has its patches
  }
};

} // namespace molmesh::contour
