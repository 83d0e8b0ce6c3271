// pass.hpp — what a pass over a mesh aims at.
#pragma once
#include "geom/pattern_search.hpp"
#include "isosurface/guard.hpp"

namespace molmesh::optimize {

/// What a pass does with an element below its goal.
struct Pass {
  float goal = 0;          ///< quality
  double cell = 1;         ///< size of the parts, in the schedule's cells
  bool worst_first = true; ///< deficit()
  /// Elements in the mesh's order, those under half of the goal before the others; else the worst ones first.
  bool in_mesh_order = false;
  double least_step = finest_step; ///< of searches for a vertex's place, pattern_search()
  bool thorough = true;            ///< Acceptance::thorough
  bool merges_and_splits = false;  ///< operations that cost more
  float tiny_share = 1;            ///< Acceptance::tiny_share
  Guard guard;
  bool operator==(const Pass&) const = default;
};

} // namespace molmesh::optimize
