// angles.cpp — the angles of elements of low quality, among which are the extremes.
#include "optimize/mesh/angles.hpp"
#include "geom/tet_measures.hpp"
#include "mesh/worst_elements.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::optimize {
namespace {

Angles of_element(const DynamicMesh& m, const Element& e) {
  const auto p = [&](size_t i) { return m.point[e.v[i]]; };
  Angles a;
  for (const double angle : dihedrals(p(0), p(1), p(2), p(3)).degree) {
    a.min = std::min(a.min, angle);
    a.max = std::max(a.max, angle);
  }
  a.below_25 = a.min < 25;
  a.above_140 = a.max > 140;
  return a;
}

Angles both(Angles a, const Angles& b) {
  a.min = std::min(a.min, b.min);
  a.max = std::max(a.max, b.max);
  a.below_25 += b.below_25;
  a.above_140 += b.above_140;
  return a;
}

Angles measure_up_to(const DynamicMesh& m, float quality, int threads) {
  constexpr int64_t grain = 16;
  return par::reduce(
      static_cast<int64_t>(m.restless.size()), threads, Angles{},
      [&](int64_t s) {
        Angles a;
        if (!m.restless[s] && m.worst[s] > quality)
          return a;
        m.for_stretch(s, [&](int64_t t) {
          if (const Element& e = m.element[t]; e.q <= quality && e.alive())
            a = both(a, of_element(m, e));
        });
        return a;
      },
      both, grain);
}

} // namespace

Angles measure_angles(const DynamicMesh& m, int threads) {
  // No element has more quality than any of its angles alone: those above this have none outside [27°, 137°].
  const auto enough = static_cast<float>(1.001 * std::max(angle_quality(27), angle_quality(137)));
  const Angles a = measure_up_to(m, enough, threads);
  return a.min < 27 && a.max > 137 ? a : measure_up_to(m, 2, threads);
}

std::string text(const Angles& a) {
  return range_text(a.min, a.max) + ", " + std::to_string(a.below_25) + " elements under 25°, " +
         std::to_string(a.above_140) + " over 140°";
}

} // namespace molmesh::optimize
