// options.hpp — what contour() is asked for, and what it tells besides the mesh.
#pragma once
#include "contour/lattice.hpp"
#include <cstdint>
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

} // namespace molmesh::contour
