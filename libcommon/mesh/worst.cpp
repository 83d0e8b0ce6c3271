// worst.cpp — one pass, each part of the mesh keeps its worst.
#include "mesh/worst.hpp"
#include "geom/tet_measures.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh {

std::vector<WorstTet> worst_tets(const TetMesh& m, AngleLimits limits, size_t most, int threads) {
  const auto beyond = [&](const WorstTet& t) { return std::max(limits.min - t.min, t.max - limits.max); };
  const auto merge = [&](std::vector<WorstTet> a, const std::vector<WorstTet>& b) {
    a.insert(a.end(), b.begin(), b.end());
    std::sort(a.begin(), a.end(), [&](const WorstTet& x, const WorstTet& y) {
      return beyond(x) != beyond(y) ? beyond(x) > beyond(y) : x.tet < y.tet;
    });
    a.resize(std::min(a.size(), most));
    return a;
  };
  return par::reduce(
      static_cast<int64_t>(m.tet.size()), threads, std::vector<WorstTet>{},
      [&](int64_t t) {
        const auto p = [&](size_t i) { return m.point[size_t(m.tet[size_t(t)][i])]; };
        const Dihedrals d = dihedrals(p(0), p(1), p(2), p(3));
        WorstTet w{t, 0.25 * (p(0) + p(1) + p(2) + p(3)), *std::min_element(d.degree, d.degree + 6),
                   *std::max_element(d.degree, d.degree + 6)};
        return beyond(w) > 0 ? std::vector<WorstTet>{w} : std::vector<WorstTet>{};
      },
      [&](std::vector<WorstTet> a, const std::vector<WorstTet>& b) {
        return b.empty() ? std::move(a) : merge(std::move(a), b);
      });
}

} // namespace molmesh
