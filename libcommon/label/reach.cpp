// reach.cpp — bounds all clusters over a box, relative to the largest.
#include "label/reach.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace molmesh::label {

using density::Box;

Reach::Reach(const density::Field& f) : f_(f) {
  std::vector<double> outer{1.0}, path;
  for (size_t l = f.level.size(); l-- > 0;) {
    path = f.level[l].exponent;
    for (const double p : path)
      bounded_ = bounded_ && p <= 1;
    if (l + 1 < f.level.size())
      for (size_t g = 0; g < path.size(); ++g)
        path[g] *= outer[f.level[l].parent[g]];
    outer = path;
  }
  power_ = path;
}

std::vector<int32_t> Reach::matter(const Box& box) const {
  const size_t clusters = f_.group.size();
  std::vector<int32_t> cluster(clusters);
  std::iota(cluster.begin(), cluster.end(), 0);
  if (!bounded_)
    return cluster;
  double least = -std::numeric_limits<double>::infinity(); // ln G is nowhere in the box below this
  for (size_t c = 0; c < clusters; ++c) {
    double farthest = 0; // squared, from any point of the box to any centre of the cluster
    for (int a = 0; a < 3; ++a) {
      const double d = std::max(f_.box[c].hi[a] - box.lo[a], box.hi[a] - f_.box[c].lo[a]);
      farthest += d * d;
    }
    least = std::max(least, power(f_.group[c]) * (f_.ln_peak[c] - f_.decay * farthest));
  }
  const double floor = least + std::log(1e-7 / static_cast<double>(clusters));
  cluster.erase(
      std::remove_if(cluster.begin(), cluster.end(),
                     [&](int32_t i) {
                       const auto c = static_cast<size_t>(i);
                       return power(f_.group[c]) * (f_.ln_peak[c] - f_.decay * distance2(box, f_.box[c])) < floor;
                     }),
      cluster.end());
  return cluster;
}

} // namespace molmesh::label
