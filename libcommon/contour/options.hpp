// options.hpp — the options and the summary of contour().
#pragma once
#include "contour/octree/lattice.hpp"
#include "contour/octree/leaves.hpp"
#include "contour/octree/owner_borders.hpp"
#include "contour/octree/sized_nodes.hpp"
#include "contour/surface/split_cell.hpp"
#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace molmesh::contour {

/// The tolerance of a grid of `spacing` Å, in spacings, where none is given: a tenth of a spacing, or 0.2 Å,
/// since triangles are off by half of what a cell's surface is off its mean plane, and no atom's place is known to
/// less than 0.1 Å. Who asks for less than 0.5 Å looks for convergence: there it is 0.4 spacings, and falls with
/// them.
inline double default_adapt(double spacing) {
  return std::max(0.1, 0.2 / std::max(0.5, spacing));
}

struct Options {
  enum Meshed { interior, exterior, both } meshed = interior;
  BoxRequest box;
  /// Allowed distance from the mean plane, in grid spacings; 0: uniform; none: default_adapt.
  std::optional<double> adapt;
  bool fill_cavities = false;
  double drop_below = 0; ///< Å³, 0: nothing
  int threads = 1;
  /// Where the inside has several owners, cells between these are the smallest ones; empty: one owner.
  FindOwners owners;
  std::vector<SizeBall> sizes; ///< not with adapt 0
  int layers = 1;              ///< as RefineOptions

  /// The side of the surface without elements in the mesh, whatever components there are; crossed: there is none.
  Side unmeshed_side() const {
    return meshed == interior && !fill_cavities    ? Side::outside
           : meshed == exterior && drop_below == 0 ? Side::inside
                                                   : Side::crossed;
  }
};

struct Summary {
  double adapt = 0; ///< as given, or by default
  int halvings = 0; ///< of the spacing: finer_grid.hpp
  int64_t leaves = 0, surface_cells = 0, split_cells = 0, restored_points = 0, relaxed_points = 0, face_points = 0,
          edge_points = 0;
  std::vector<double> molecule_volumes,
      cavity_volumes; ///< Å³ of each component, in the order of the octree's curve
  int64_t dropped_parts = 0, filled_cavities = 0;
};

/// What the octree over the lattice has to be like. halvings: of the grid's spacing to the lattice's.
RefineOptions refine_options(const Lattice& lattice, const Options& options, double grid_spacing, int halvings);

} // namespace molmesh::contour
