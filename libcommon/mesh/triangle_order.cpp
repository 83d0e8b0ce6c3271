// triangle_order.cpp — sorts by the Morton codes of the centroids.
#include "mesh/triangle_order.hpp"
#include "geom/morton.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace molmesh {

std::vector<int32_t> order_along_curve(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads) {
  Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = -low;
  for (const Tri& t : tri)
    for (const int32_t v : t)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], point[v][k]);
        high[k] = std::max(high[k], point[v][k]);
      }
  std::vector<std::pair<uint64_t, int32_t>> order(tri.size());
  par::for_n(static_cast<int64_t>(tri.size()), threads, [&](int64_t t) {
    Vec3i cell;
    for (int k = 0; k < 3; ++k) {
      double place = 0; // of thrice the centroid
      for (const int32_t v : tri[t])
        place += point[v][k] - low[k];
      const double extent = 3 * (high[k] - low[k]);
      cell[k] = static_cast<int32_t>(extent > 0 ? place / extent * ((1 << 21) - 1) : 0);
    }
    order[t] = {morton(cell), static_cast<int32_t>(t)};
  });
  par::sort(order, threads);
  std::vector<int32_t> index;
  index.reserve(tri.size());
  for (const auto& [code, t] : order)
    index.push_back(t);
  return index;
}

} // namespace molmesh
