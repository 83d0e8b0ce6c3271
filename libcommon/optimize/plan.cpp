// plan.cpp — memory and time for each element and triangle are measured (docs/benchmarks.md, Plans).
#include "optimize/plan.hpp"
#include <cmath>

namespace molmesh::optimize {

Plan plan(int64_t elements, int64_t triangles, int64_t blocks, int iterations, Effort effort) {
  const auto n = static_cast<double>(elements), surface = static_cast<double>(triangles);
  Plan p;
  p.elements = iterations > 0 ? std::llround(1.025 * n) : elements;
  p.memory = std::llround(1.06 * (18.7e6 + 61.4 * n + 722 * surface + 2200 * static_cast<double>(blocks)));
  const double share = effort == Effort::fast ? 0.2 : effort == Effort::good ? 1 : 2; // of good's time
  p.seconds = 0.05 + 5e-7 * n + (iterations > 0 ? share * 4.5e-5 * surface : 0);
  return p;
}

} // namespace molmesh::optimize
