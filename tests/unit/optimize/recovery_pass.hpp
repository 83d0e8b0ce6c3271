// recovery_pass.hpp — a pass that brings points back as tetsmooth's do.
#pragma once
#include "optimize/schedule/schedule.hpp"

namespace molmesh::test {

inline const Guard recovery_guard{44, 0.24, 1, 0};

/// cell: size of the parts, in the schedule's cells.
inline optimize::Pass recovery_pass(double cell) {
  optimize::Pass pass;
  pass.goal = static_cast<float>(angle_quality(26));
  pass.effort = 1;
  pass.cell = cell;
  pass.guard = recovery_guard;
  return pass;
}

} // namespace molmesh::test
