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
  int64_t low = -1;    ///< count_low(); -1: not known, as many as elements and edges across usually come with
  int64_t across = -1; ///< count_across(); -1: not known, as many as a surface usually has
  int64_t blocks = 0;  ///< of the density's grid, 0: none
  int iterations = 15; ///< 0 leaves the mesh as it is
  Effort effort = Effort::good;
  int threads = 1;
};

/// Elements that take the most time: those that are far below what any effort aims at.
int64_t count_low(const TetMesh& mesh, int threads);

/// Edges across a thin place: both ends are of the surface, the edge is not. Points there are searched for the
/// longest.
int64_t count_across(const TetMesh& mesh, int threads);

Plan plan(const Work& work);

} // namespace molmesh::optimize
