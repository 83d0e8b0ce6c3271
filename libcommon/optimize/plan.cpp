// plan.cpp — memory and time for each element, triangle and thin place are measured (docs/benchmarks.md, Plans).
#include "optimize/plan.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {
namespace {

/// Seconds for each element and triangle, and for each split cell: where the surface is thin, points and elements
/// are searched for that no single operation improves. Bytes that such a search takes, in each thread.
struct Effect {
  double element, triangle, split, search;
};
Effect effect_of(Effort effort) {
  switch (effort) {
  case Effort::fast:
    return {0.4e-6, 3e-6, 0.0025, 2e6};
  case Effort::best:
    return {1.6e-6, 15e-6, 0.045, 14e6};
  default:
    return {1.6e-6, 0, 0.016, 4e6};
  }
}

} // namespace

Plan plan(const Work& work) {
  const auto n = static_cast<double>(work.elements), surface = static_cast<double>(work.triangles);
  const double split = work.split < 0 ? 0.003 * surface : static_cast<double>(work.split);
  const Effect e = effect_of(work.effort);
  const bool improves = work.iterations > 0;
  Plan p;
  p.elements = work.elements;
  p.memory = std::llround(8.5e6 + 63 * n + 720 * surface + 2200 * static_cast<double>(work.blocks) +
                          (improves ? std::min(e.search, 100 * n) * work.threads : 0));
  p.seconds = 0.02 + 3e-7 * n + (improves ? e.element * n + e.triangle * surface + e.split * split : 0);
  return p;
}

} // namespace molmesh::optimize
