// plan.hpp — what improving a mesh takes, before it is done.
#pragma once
#include "optimize/optimize.hpp"
#include <cstdint>

namespace molmesh::optimize {

struct Plan {
  int64_t elements = 0; ///< after the improvement
  int64_t memory = 0;   ///< bytes at the peak of tetsmooth
  double seconds = 0;   ///< of one core of the machine of docs/benchmarks.md
};

/// elements, triangles: of the mesh that comes in; blocks: of the density's grid, 0: none. iterations: 0 leaves the
/// mesh as it is.
Plan plan(int64_t elements, int64_t triangles, int64_t blocks, int iterations, Effort effort = Effort::good);

} // namespace molmesh::optimize
