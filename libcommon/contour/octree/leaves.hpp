// leaves.hpp — the fine cells that the surface crosses, and the leaves of the balanced octree over them.
#pragma once
#include "base/large_array.hpp"
#include "contour/octree/lattice.hpp"
#include "contour/octree/octree.hpp"
#include "contour/surface/surface_cell.hpp"
#include "par/passes.hpp"
#include <vector>

namespace molmesh::contour {

/// Every cell of the lattice that the surface crosses.
struct Surface {
  LargeArray<SurfaceCell> cells;     ///< ascending by key
  LargeArray<SurfaceSample> samples; ///< [cells]
};

/// Throws Error(bad_input) when the surface crosses a cell with an inactive corner: such a grid does not hold every
/// band cell (I2).
Surface find_surface(const Lattice& lattice, int threads);

struct RefineOptions {
  /// Allowed distance of a cell's fine surface from its mean plane, in fine spacings; 0: every surface cell stays
  /// fine and so does every cell of the grid in the regions below. Halved until the chords of all cells cut off
  /// little of the volume (chord_items.hpp).
  double adapt = 0;
  bool inside = true, outside = true; ///< regions to mesh
  /// [level - 1] Nodes that have children whatever the surface needs: words of 4³ nodes, ascending.
  std::vector<std::vector<par::KeyedWord>> divided = {};
  /// Likewise, nodes that may be one cell with a surface up to an eighth of their edge off its mean plane, where
  /// that is more than adapt. Where chords cut off too much this is halved first.
  std::vector<std::vector<par::KeyedWord>> loose = {};
  /// Layers of leaves of each size round those of half that size; balance needs one.
  int layers = 1;
};

/// A node of the octree has children where its surface cells may not be one (more than one component of the
/// surface, further than `adapt` from the mean plane, or of another topology), where the surface passes close to a
/// face with children behind, where it reaches beyond the lattice, and for balance: see octree.hpp.
LeafList select_leaves(const Lattice& lattice, const Surface& surface, const RefineOptions& options, int threads);

} // namespace molmesh::contour
