// triangle_match.cpp — groups faces and triangles by their three points.
#include "mesh/triangle_match.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/sorted_triangle.hpp"

namespace molmesh {

TriangleMatch match_triangles(const TetMesh& m, const LargeArray<int32_t>& across,
                              const std::vector<int64_t>& boundary, int threads) {
  const auto region = [&](int64_t face) { return m.region[face / 4]; };
  const RegionOrder order(m);
  TriangleMatch r;
  for (int64_t f : boundary)
    if (const int32_t other = region_across(m, across, f); other == 0 || order.is_first(region(f), other))
      r.owner.push_back(f);
  const auto n = static_cast<int64_t>(r.owner.size()), tris = static_cast<int64_t>(m.tri.size());
  const auto corners = [&](int64_t i) { return i < n ? face_points(m, r.owner[i]) : m.tri[i - n]; };
  r.kind.assign(static_cast<size_t>(n + tris), TriangleMatch::good);
  r.one_sided.assign(static_cast<size_t>(tris), 0);
  for_each_group(
      n + tris, static_cast<int64_t>(m.point.size()), threads, [&](int64_t i) { return triangle_key(corners(i)); },
      [&](const uint32_t* item, int size) { // a face first, if there is one
        if (item[0] >= n) {
          for (int i = 0; i < size; ++i)
            r.kind[item[i]] = i == 0 ? TriangleMatch::stray : TriangleMatch::twice;
          return;
        }
        if (size == 1)
          r.kind[item[0]] = TriangleMatch::missing;
        const int64_t f = r.owner[item[0]];
        const int32_t other = region_across(m, across, f);
        for (int i = 1; i < size; ++i) {
          const auto t = static_cast<size_t>(item[i] - n);
          const bool right =
              same_turn(m.tri[t], face_points(m, f)) == triangle_looks_out(order, region(f), other, m.boundary[t]);
          r.kind[item[i]] = i > 1 ? TriangleMatch::twice : right ? TriangleMatch::good : TriangleMatch::turned;
          r.one_sided[t] = other == 0;
        }
      });
  return r;
}

} // namespace molmesh
