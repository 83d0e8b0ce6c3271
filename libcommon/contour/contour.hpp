// contour.hpp — density to a conforming tetrahedral mesh of the molecule, its surroundings, or both.
// Adaptive dual contouring, section 4 of Liao et al. 2013.
#pragma once
#include "contour/dual.hpp"
#include "contour/lattice.hpp"
#include "contour/leaves.hpp"
#include "density/block_grid.hpp"
#include "mesh/tet_mesh.hpp"
#include <functional>
#include <string>
#include <vector>

namespace molmesh::contour {

struct Options {
  enum Meshed { interior, exterior, both } meshed = interior;
  BoxRequest box;
  double adapt = 0.1; ///< allowed distance from the mean plane, in grid spacings; 0: uniform
  bool fill_cavities = false;
  double drop_below = 0; ///< Å³, 0: nothing
  int threads = 1;
};

struct Summary {
  int64_t leaves = 0, surface_cells = 0, split_cells = 0, restored_points = 0, relaxed_points = 0, face_points = 0,
          edge_points = 0;
  std::vector<double> molecule_volumes, cavity_volumes; ///< Å³ of each part, in the order of the octree's curve
  int64_t dropped_parts = 0, filled_cavities = 0;
};

/// The stages that a device does too.
struct Stages {
  std::function<Surface(const Lattice&, int threads)> find_surface = contour::find_surface;
  std::function<LeafList(const Lattice&, const Surface&, const RefineOptions&, int threads)> select_leaves =
      contour::select_leaves;
  DualFunction make_dual = contour::make_dual;
};

/// on_phase is called with the name of each phase as it starts. Throws Error(failed) when the grid has no surface
/// or the surface meets a wall that was not asked to cut it.
TetMesh contour(const BlockGrid& grid, const Options& options, Summary& summary,
                const std::function<void(const std::string&)>& on_phase, const Stages& stages = {});

} // namespace molmesh::contour
