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

/// What comes in, and how it is improved.
struct Work {
  int64_t elements = 0, triangles = 0;
  int64_t low = -1;    ///< count_low(); -1: not known, as many as elements and split cells usually come with
  int64_t split = -1;  ///< cells of the grid with two pieces of the surface; -1: not known, as many as usual
  int64_t blocks = 0;  ///< of the density's grid, 0: none
  int iterations = 15; ///< 0 leaves the mesh as it is
  Effort effort = Effort::good;
  int threads = 1;
};

/// Elements that take the most time: those that are far below what any effort aims at.
int64_t count_low(const TetMesh& mesh, int threads);

Plan plan(const Work& work);

} // namespace molmesh::optimize
