// strategy.hpp — one row of a table of local searches: what it is for, what it may try, how far, how long.
#pragma once
#include "isosurface/guard.hpp"
#include <cstddef>
#include <cstdint>

namespace molmesh::optimize {

/// What parts are made around, and what has to become fewer in them.
enum class Scope : uint8_t {
  points,   ///< surface points off the target: they come back to it or leave the surface
  elements, ///< elements below the goal, no points
};

/// What is tried for a point; each does more than the one before.
enum class Moves : uint8_t {
  bold,    ///< one operation at the point; what is repaired in part is searched further
  necks,   ///< and the surface follows necks
  bending, ///< and it may bend during repair, where it has elements on both sides
};

struct Strategy {
  Scope scope = Scope::points;
  Moves moves = Moves::bold;
  Guard guard;
  double part_size = 0.5; ///< of the cube around each point, in the schedule's cells
  float goal_share = 1;   ///< points come back to this share of the goal first
  int hill_climbing = 0;  ///< trials at most: first improvement
  int threshold = 0;      ///< trials at most: threshold accepting, after hill climbing
  // Of one run.
  size_t most_elements = 64; ///< Scope::elements: nothing is done where more are below the goal
  float goal = 0;            ///< quality
  bool worst_first = true;   ///< deficit(), in the first round of each repair; the other one in the second
  bool operator==(const Strategy&) const = default;
};

} // namespace molmesh::optimize
