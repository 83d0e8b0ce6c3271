// complex.hpp — the octree's leaves as a face-to-face complex of convex cells, with a dual vertex in each.
// Section 4.1 of Liao et al. 2013. Every mesh is the dual of this complex; see elements.hpp.
#pragma once
#include "contour/lattice.hpp"
#include "contour/octree.hpp"
#include "contour/split_cell.hpp"
#include "contour/surface_cells.hpp"
#include "contour/surface_sample.hpp"
#include "density/large_array.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::contour {

/// Everything known per leaf and per vertex of the complex. Vertex ids: grid points first, then one dual vertex per
/// leaf (dual0 + leaf), then for each split cell its centre and the dual vertices of its pieces.
struct Complex {
  Complex(const Lattice& lattice, const Octree& tree, const LargeArray<SurfaceCell>& cells,
          const LargeArray<SurfaceSample>& samples, int threads);

  const Lattice& lattice;
  const Octree& tree;
  const LargeArray<SurfaceCell>& cells;
  const LargeArray<SurfaceSample>& samples; ///< [cells]

  std::vector<Side> side;           ///< [leaves]
  std::vector<int32_t> grid_vertex; ///< [8·leaves] vertex id of each corner
  std::vector<int32_t> first_cell;  ///< [leaves] first surface cell within, -1 none
  std::vector<int32_t> split;       ///< [leaves] first vertex id of a split cell (its centre), -1: not split
  int32_t grid_vertices = 0, dual0 = 0;

  std::vector<Vec3d> position; ///< [vertices] Å
  std::vector<float> value;    ///< [vertices] G at grid points and split centres; isovalue elsewhere
  std::vector<Vec3i> point;    ///< [grid vertices] lattice point
  /// [grid vertices] estimated distance to the surface, Å, positive inside; 0: unknown, or no surface cell's
  std::vector<float> distance;

  bool inside(int32_t vertex) const { return value[static_cast<size_t>(vertex)] > lattice.isovalue; }
  bool is_split(int32_t leaf) const { return split[static_cast<size_t>(leaf)] >= 0; }
  int32_t dual(int32_t leaf) const { return dual0 + leaf; }
  /// Leaf of a dual vertex, a split cell's centre or a piece; -1 for grid points and anything after.
  int32_t leaf_of(int32_t vertex) const;
  /// Topology of a fine surface cell's leaf.
  CellTopology topology(int32_t leaf) const;
  /// Dual vertex of the piece of a split leaf behind face f; off: the triangle's corner off the diagonal, -1 for a
  /// square.
  int32_t piece_dual(int32_t leaf, const SplitCell& s, int f, int off) const;
  int32_t piece_dual(int32_t leaf, const SplitCell& s, const Patch& p) const;
  /// Puts moved grid points back where the lattice has them and the dual vertices around them where they belong.
  /// Returns the leaves with one of these corners.
  std::vector<int32_t> restore(const std::vector<int32_t>& grid_vertex_ids, int threads);
  /// Leaves with a flagged corner, ascending. flag: [grid vertices]
  std::vector<int32_t> leaves_at(const std::vector<uint8_t>& flag, int threads) const;
  bool moved(int32_t vertex) const { return vertex < grid_vertices && moved_[static_cast<size_t>(vertex)]; }
  /// Surface cells within a leaf: first_cell[leaf] up to here.
  int32_t end_cell(int32_t leaf) const;
  /// [vertices] 1: a grid point of no surface cell; 2 + level: a dual vertex of no surface cell; 0: any other.
  std::vector<uint8_t> lattice_classes() const;
  /// Where the surface crosses the edge between two vertices on opposite sides, Å. Coarse edges whose ends have not
  /// moved are searched on the fine grid.
  Vec3d crossing(int32_t a, int32_t b) const;
  const std::vector<uint8_t>& moved_flags() const { return moved_; }       ///< [grid vertices]
  const std::vector<int32_t>& nearest_samples() const { return nearest_; } ///< [grid vertices]
  /// Nearest sample in the leaves round a grid point, -1: none.
  int32_t nearest_sample(int32_t vertex) const { return nearest_[static_cast<size_t>(vertex)]; }

private:
  void number_grid_vertices(int threads);
  void keep_distance(int threads);
  bool estimate_distance(int32_t v, Vec3d foot, double& d, Vec3d& inwards) const;
  void number_pieces(int threads);
  void place(int32_t leaf);
  Vec3d mean_crossing(int32_t leaf) const;
  Vec3d onto_surface(int32_t leaf, Vec3d x) const;
  void place_split(int32_t leaf);
  std::vector<uint8_t> moved_;
  std::vector<int32_t> nearest_;    ///< [grid vertices] nearest sample in the leaves around, -1: none
  std::vector<float> estimate_;     ///< [grid vertices] distance before the move
  std::vector<int32_t> split_leaf_; ///< [vertices after the leaves' duals]
};

} // namespace molmesh::contour
