// worst_elements.cpp — keeps the worst of each part of the mesh, in one pass.
#include "mesh/worst_elements.hpp"
#include "geom/tet_measures.hpp"
#include "mesh/tet_mesh.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <iomanip>
#include <sstream>

namespace molmesh {

namespace {

WorstTet measure(const TetMesh& m, int64_t t) {
  const auto p = [&](size_t i) { return m.point[m.tet[t][i]]; };
  const Dihedrals d = dihedrals(p(0), p(1), p(2), p(3));
  return {t, cell_centroid(m, size_t(t)), *std::min_element(d.degree, d.degree + 6),
          *std::max_element(d.degree, d.degree + 6)};
}

} // namespace

int64_t count_beyond(const TetMesh& m, AngleLimits limits, int threads) {
  return par::reduce(
      static_cast<int64_t>(m.tet.size()), threads, int64_t{0},
      [&](int64_t t) {
        const WorstTet w = measure(m, t);
        return int64_t{!limits.hold(w.min) || !limits.hold(w.max)};
      },
      [](int64_t a, int64_t b) { return a + b; });
}

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
        const WorstTet w = measure(m, t);
        return beyond(w) > AngleLimits::rounding ? std::vector<WorstTet>{w} : std::vector<WorstTet>{};
      },
      [&](std::vector<WorstTet> a, const std::vector<WorstTet>& b) {
        return b.empty() ? std::move(a) : merge(std::move(a), b);
      });
}

std::string range_text(double min, double max) {
  std::ostringstream s;
  s << std::fixed << std::setprecision(2);
  s << min << "° to " << max << "°";
  return s.str();
}

std::string described(const WorstTet& t) {
  std::ostringstream s;
  s << std::fixed << std::setprecision(3);
  s << "element " << t.tet << " has " << range_text(t.min, t.max) << ", at " << t.centre.x << ' ' << t.centre.y
    << ' ' << t.centre.z << " Å";
  return s.str();
}

} // namespace molmesh
