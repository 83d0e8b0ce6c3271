// plan.cpp — memory and time for each element, triangle and thin place are measured (docs/benchmarks.md, Plans).
#include "optimize/plan.hpp"
#include "geom/tet_quality.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <functional>

namespace molmesh::optimize {
namespace {

/// Beside an ordinary effort: of the time that elements take, those of low quality, and searches; and bytes for
/// each element more.
struct Effect {
  double elements, low, searches, room;
};
Effect effect_of(Effort effort) {
  switch (effort) {
  case Effort::fast:
    return {1.1, 0.35, 0.167, 0};
  case Effort::best:
    return {7.5, 1.4, 5, 100};
  default:
    return {1, 1, 1, 0};
  }
}

constexpr double low_angle = 18; // degrees
// In so many split cells of a grid some point is searched for, in a part of so many elements at most, and of more
// some take long.
constexpr double some_split = 20, many_split = 100, largest_part = 120e3;

} // namespace

int64_t count_low(const TetMesh& mesh, int threads) {
  const auto least = static_cast<float>(angle_quality(low_angle));
  return par::reduce(
      std::ssize(mesh.tet), threads, int64_t{0},
      [&](int64_t i) {
        const Tet& t = mesh.tet[i];
        const auto p = [&](int k) { return mesh.point[t[k]]; };
        return int64_t{tet_quality(p(0), p(1), p(2), p(3)) < least};
      },
      std::plus<int64_t>());
}

Plan plan(const Work& work) {
  const auto n = static_cast<double>(work.elements), surface = static_cast<double>(work.triangles);
  const double split = work.split < 0 ? 0.003 * surface : static_cast<double>(work.split);
  const double low = work.low < 0 ? 0.0185 * n + 105 * split : static_cast<double>(work.low);
  const Effect e = effect_of(work.effort);
  const bool improves = work.iterations > 0;
  Plan p;
  p.elements = work.elements;
  const double part = std::min(n, largest_part) * std::min(1., split / some_split); // copied by what searches in it
  p.memory =
      std::llround(9.9e6 + 60 * n + 690 * surface + 2200 * static_cast<double>(work.blocks) +
                   (improves ? e.room * n + (work.effort == Effort::fast ? 0 : 36 * part) * work.threads : 0));
  const double searches = 5.9e-3 * split + 5.1e-3 * std::max(0., split - many_split);
  p.seconds =
      0.012 + 2.6e-7 * n + (improves ? e.elements * 1.6e-7 * n + e.low * 6e-5 * low + e.searches * searches : 0);
  return p;
}

} // namespace molmesh::optimize
