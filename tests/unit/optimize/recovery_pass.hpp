// recovery_pass.hpp — passes and searches as tetsmooth's.
#pragma once
#include "optimize/schedule/schedule.hpp"

namespace molmesh::test {

inline const Guard recovery_guard{44, 0.24, 1, 0};

/// cell: size of the parts, in the schedule's cells.
inline optimize::Pass recovery_pass(double cell) {
  optimize::Pass pass;
  pass.goal = static_cast<float>(angle_quality(26));
  pass.merges_and_splits = true;
  pass.cell = cell;
  pass.guard = recovery_guard;
  return pass;
}

/// Brings points back. size: of the parts, in the schedule's cells.
inline optimize::Strategy recovery(double size, optimize::Moves moves = optimize::Moves::bold) {
  optimize::Strategy s;
  s.moves = moves;
  s.hill_climbing = moves == optimize::Moves::bold ? 0 : moves == optimize::Moves::bending ? 2000 : 300;
  s.goal = static_cast<float>(angle_quality(26));
  s.part_size = size;
  s.guard = recovery_guard;
  return s;
}

} // namespace molmesh::test
