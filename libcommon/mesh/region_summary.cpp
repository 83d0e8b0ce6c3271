// region_summary.cpp — collects regions by label and adds volumes without losing what rounding drops.
#include "mesh/region_summary.hpp"
#include "geom/predicates.hpp"
#include "mesh/adjacency.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh {

std::vector<RegionSummary> summarize_regions(const TetMesh& m, const std::vector<int64_t>& side, int threads) {
  std::vector<int32_t> names;
  for (int32_t r : m.region)
    if (names.empty() || r != names.back())
      names.push_back(r);
  par::sort_unique(names, 1);
  const auto index = [&](int32_t region) {
    return static_cast<int32_t>(std::lower_bound(names.begin(), names.end(), region) - names.begin());
  };
  std::vector<Tri> boundary;
  std::vector<int32_t> label;
  for (int64_t f : side) {
    boundary.push_back(face_points(m, f));
    label.push_back(index(m.region[f / 4]));
  }
  const auto summaries = summarize_surfaces(m.point, boundary, label, static_cast<int32_t>(names.size()), threads);
  std::vector<RegionSummary> region;
  for (size_t r = 0; r < names.size(); ++r)
    region.push_back({names[r], 0, 0, summaries[r]});
  std::vector<double> lost(names.size()); // the sums must tell a box from its volumes
  const auto point = [&](int32_t i) { return m.point[i]; };
  for (size_t i = 0; i < m.tet.size(); ++i) {
    const Tet& t = m.tet[i];
    const auto k = static_cast<size_t>(index(m.region[i]));
    const TwoTerms sum = two_sum(region[k].volume, tet_volume(point(t[0]), point(t[1]), point(t[2]), point(t[3])));
    ++region[k].tets;
    region[k].volume = sum.sum;
    lost[k] += sum.error;
  }
  for (size_t r = 0; r < names.size(); ++r)
    region[r].volume += lost[r];
  return region;
}

} // namespace molmesh
