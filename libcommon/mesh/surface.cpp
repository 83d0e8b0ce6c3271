// surface.cpp — pairs half edges by their ends and walks the fans around each point.
#include "mesh/surface.hpp"
#include "geom/tet_measures.hpp"
#include "mesh/disjoint_sets.hpp"
#include "mesh/group_by_key.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh {
namespace {

// Half edge 3 t + i runs from corner i of triangle t to the next corner; it also names that corner.
constexpr int64_t next_half(int64_t h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
constexpr int64_t previous_half(int64_t h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

/// torn: several, with more triangles that run along it one way than the other.
enum Kind : uint8_t { none, good, open, several, torn };

struct HalfEdges {
  std::vector<int32_t> mate;   ///< [halves] the half edge on the other side, or -1
  std::vector<uint8_t> edge;   ///< [halves] Kind of the edge, at its first half; none elsewhere
  std::vector<uint8_t> corner; ///< [halves] Kind of the point, at its first corner; several: several fans
};

class Walker {
public:
  explicit Walker(const std::vector<int32_t>& mate) : mate_(mate) {}
  /// Corners in the fan of c.
  int64_t fan(int64_t c) const {
    int64_t n = 1, h = c;
    while ((h = mate_[h]) >= 0 && (h = next_half(h)) != c)
      ++n;
    if (h >= 0)
      return n; // closed
    for (h = c; (h = mate_[previous_half(h)]) >= 0;)
      ++n;
    return n;
  }

private:
  const std::vector<int32_t>& mate_;
};

HalfEdges pair_halves(const std::vector<Tri>& tri, const std::vector<int32_t>& label, int64_t points, int threads) {
  const auto halves = static_cast<int64_t>(3 * tri.size());
  const auto from = [&](int64_t h) { return tri[h / 3][h % 3]; };
  const auto to = [&](int64_t h) { return from(next_half(h)); };
  const auto label_bits = [&](int64_t h) { return uint64_t(uint32_t(label[h / 3])) << 32; };
  HalfEdges e;
  e.mate.assign(static_cast<size_t>(halves), -1);
  e.edge.assign(static_cast<size_t>(halves), none);
  e.corner.assign(static_cast<size_t>(halves), none);
  for_each_group(
      halves, points, threads,
      [&](int64_t h) {
        const int32_t a = from(h), b = to(h);
        return GroupKey{std::min(a, b), label_bits(h) | uint32_t(std::max(a, b))};
      },
      [&](const uint32_t* h, int n) {
        if (n == 2 && from(h[0]) != from(h[1])) {
          e.mate[h[0]] = static_cast<int32_t>(h[1]);
          e.mate[h[1]] = static_cast<int32_t>(h[0]);
        }
        const auto one_way = std::count_if(h, h + n, [&](uint32_t k) { return from(k) == from(h[0]); });
        e.edge[h[0]] = n == 1 ? open : 2 * one_way != n ? torn : n == 2 ? good : several;
      });
  const Walker walker(e.mate);
  for_each_group(
      halves, points, threads,
      [&](int64_t h) {
        return GroupKey{from(h), label_bits(h)};
      },
      [&](const uint32_t* c, int n) { e.corner[c[0]] = walker.fan(c[0]) == n ? good : several; });
  return e;
}

} // namespace

std::vector<SurfaceSummary> summarize_surfaces(const std::vector<Vec3d>& point, const std::vector<Tri>& tri,
                                               const std::vector<int32_t>& label, int32_t labels, int threads) {
  std::vector<SurfaceSummary> summary(static_cast<size_t>(labels));
  if (tri.empty())
    return summary;
  const HalfEdges e = pair_halves(tri, label, static_cast<int64_t>(point.size()), threads);

  DisjointSets pieces(tri.size());
  for (size_t h = 0; h < e.mate.size(); ++h)
    if (e.mate[h] >= 0)
      pieces.join(static_cast<int32_t>(h / 3), e.mate[h] / 3);

  const Vec3d origin = point[tri[0][0]]; // volumes cancel less when seen from nearby
  for (size_t t = 0; t < tri.size(); ++t) {
    SurfaceSummary& s = summary[label[t]];
    const Vec3d a = point[tri[t][0]], b = point[tri[t][1]], c = point[tri[t][2]];
    ++s.triangles;
    s.components += pieces.first(static_cast<int32_t>(t)) == static_cast<int32_t>(t);
    s.area += tri_area(a, b, c);
    s.volume += dot(cross(a - origin, b - origin), c - origin) / 6;
    for (size_t i = 0; i < 3; ++i) {
      const size_t h = 3 * t + i;
      const std::array<int32_t, 2> ends{tri[t][i], tri[t][(i + 1) % 3]};
      s.edges += e.edge[h] != none;
      s.points += e.corner[h] != none;
      if (e.edge[h] == open && s.faults.open_edges++ == 0)
        s.faults.open_edge = ends;
      if (e.edge[h] == torn)
        s.volume = std::nan("");
      if ((e.edge[h] == several || e.edge[h] == torn) && s.faults.crowded_edges++ == 0)
        s.faults.crowded_edge = ends;
      if (e.corner[h] == several && s.faults.pinched_points++ == 0)
        s.faults.pinched_point = tri[t][i];
    }
  }
  for (SurfaceSummary& s : summary) {
    s.euler = s.points - s.edges + s.triangles;
    if (s.faults.open_edges > 0)
      s.volume = std::nan("");
  }
  return summary;
}

SurfaceSummary summarize_surface(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads) {
  return summarize_surfaces(point, tri, std::vector<int32_t>(tri.size(), 0), 1, threads)[0];
}

} // namespace molmesh
