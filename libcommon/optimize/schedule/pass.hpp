// pass.hpp — what a pass over a mesh aims at.
#pragma once
#include "geom/pattern_search.hpp"
#include "isosurface/guard.hpp"

namespace molmesh::optimize {

/// What a pass does with an element below its goal.
struct Pass {
  float goal = 0;  ///< quality
  double cell = 1; ///< size of the parts, in the schedule's cells
  bool worst_first = true;
  /// Elements in the mesh's order, those under half of the goal before the others; else the worst ones first.
  bool in_mesh_order = false;
  double least_step = finest_step; ///< of searches for a vertex's place, pattern_search()
  /// 1: merges and splits too. Of recover(): 2: what cannot be mended is shaken; 3: the surface follows necks; 4:
  /// where it has elements on both sides it may bend while they are mended; 5: and what shaking cannot mend
  /// wanders.
  int effort = 0;
  /// Of recover(): points come back to this share of the goal, and the elements around are mended after.
  float at_first = 1;
  float yield = 1; ///< Editor::yield
  Guard guard;
  bool operator==(const Pass&) const = default;
};

} // namespace molmesh::optimize
