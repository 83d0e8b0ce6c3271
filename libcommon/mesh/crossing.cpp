// crossing.cpp — a tree of boxes over the triangles along a space-filling curve.
#include "mesh/crossing.hpp"
#include "geom/intersect.hpp"
#include "geom/morton.hpp"
#include "mesh/box_tree.hpp"
#include <algorithm>
#include <utility>

namespace molmesh {
namespace {

// Triangles along the curve: what is near on it is near in space.
std::vector<Tri> along_curve(const std::vector<Vec3d>& point, const std::vector<Tri>& tri,
                             std::vector<int32_t>& index, int threads) {
  Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = -low;
  for (const Tri& t : tri)
    for (const int32_t v : t)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], point[size_t(v)][k]);
        high[k] = std::max(high[k], point[size_t(v)][k]);
      }
  std::vector<std::pair<uint64_t, int32_t>> order(tri.size());
  par::for_n(static_cast<int64_t>(tri.size()), threads, [&](int64_t t) {
    Vec3i cell;
    for (int k = 0; k < 3; ++k) {
      double place = 0; // of thrice the centroid
      for (const int32_t v : tri[size_t(t)])
        place += point[size_t(v)][k] - low[k];
      const double extent = 3 * (high[k] - low[k]);
      cell[k] = static_cast<int32_t>(extent > 0 ? place / extent * ((1 << 21) - 1) : 0);
    }
    order[size_t(t)] = {morton(cell), static_cast<int32_t>(t)};
  });
  par::sort(order, threads);
  std::vector<Tri> sorted;
  sorted.reserve(tri.size());
  index.reserve(tri.size());
  for (const auto& [code, t] : order) {
    sorted.push_back(tri[size_t(t)]);
    index.push_back(t);
  }
  return sorted;
}

} // namespace

Crossings find_crossings(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads) {
  std::vector<int32_t> index;
  const std::vector<Tri> sorted = along_curve(point, tri, index, threads);
  const auto box = [&](size_t i) {
    const Tri& t = sorted[i];
    return box_around(point[size_t(t[0])], point[size_t(t[1])], point[size_t(t[2])]);
  };
  const BoxTree tree(sorted.size(), box, threads);
  const auto after = [&](int64_t i) {
    Crossings c;
    tree.any(
        box(size_t(i)),
        [&](size_t j) {
          if (triangles_cross(point, sorted[size_t(i)], sorted[j])) {
            const std::array<int32_t, 2> pair{std::min(index[size_t(i)], index[j]),
                                              std::max(index[size_t(i)], index[j])};
            c.first = c.pairs++ == 0 ? pair : std::min(c.first, pair);
          }
          return false;
        },
        size_t(i) + 1);
    return c;
  };
  return par::reduce(
      static_cast<int64_t>(tri.size()), threads, Crossings{}, after,
      [](const Crossings& a, const Crossings& b) {
        const auto first = a.pairs == 0 ? b.first : b.pairs == 0 ? a.first : std::min(a.first, b.first);
        return Crossings{a.pairs + b.pairs, first};
      },
      256);
}

} // namespace molmesh
