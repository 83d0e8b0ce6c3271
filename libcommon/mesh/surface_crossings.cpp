// surface_crossings.cpp — searches a tree of boxes over the triangles along a space-filling curve.
#include "mesh/surface_crossings.hpp"
#include "geom/intersect.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/triangle_order.hpp"
#include <algorithm>

namespace molmesh {
Crossings find_crossings(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads) {
  const std::vector<int32_t> index = order_along_curve(point, tri, threads);
  const std::vector<Tri> sorted = in_order(tri, index);
  const auto box = [&](size_t i) {
    const Tri& t = sorted[i];
    return box_around(point[t[0]], point[t[1]], point[t[2]]);
  };
  const BoxTree tree(sorted.size(), box, threads);
  const auto after = [&](int64_t i) {
    Crossings c;
    tree.any(
        box(size_t(i)),
        [&](size_t j) {
          if (triangles_cross(point, sorted[i], sorted[j])) {
            const std::array<int32_t, 2> pair{std::min(index[i], index[j]), std::max(index[i], index[j])};
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
