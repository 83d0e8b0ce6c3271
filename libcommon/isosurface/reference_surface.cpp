// reference_surface.cpp — a tree of the triangles' boxes, and the closest point of one.
#include "isosurface/reference_surface.hpp"
#include "geom/morton.hpp"
#include <algorithm>
#include <bit>
#include <cmath>

namespace molmesh {
namespace {

constexpr int most_looked_at = 48;  // triangles for one closest point, usually
constexpr int all_looked_at = 1024; // the nearest of these is taken: in the middle of a fan all are as near

// Closest point of triangle a b c to p, by the regions of its corners, edges and face (Ericson 2005, 5.1.5).
Vec3d closest_on(Vec3d a, Vec3d b, Vec3d c, Vec3d p) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0)
    return a;
  if (d3 >= 0 && d4 <= d3)
    return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return a + d1 / (d1 - d3) * ab;
  if (d6 >= 0 && d5 <= d6)
    return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

// The mean of those up to four times the median: an outer surface may be thousands of times coarser.
double typical(const std::vector<double>& edges) {
  std::vector<double> sorted = edges;
  const auto median = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), median, sorted.end());
  double sum = 0, count = 0;
  for (const double e : edges)
    if (e <= 4 * *median)
      sum += e, ++count;
  return sum / count;
}

} // namespace

ReferenceSurface::ReferenceSurface(const TetMesh& mesh, const std::vector<uint8_t>& take) {
  static std::atomic<uint64_t> surfaces{0};
  number_ = ++surfaces;
  std::vector<double> edges;
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    if (!take[t])
      continue;
    const auto p = [&](size_t i) { return mesh.point[mesh.tri[t][i]]; };
    const Vec3d n = cross(p(1) - p(0), p(2) - p(0));
    triangle_.push_back({p(0), p(1), p(2), n / std::max(norm(n), 1e-300), static_cast<int32_t>(triangle_.size())});
    edges.insert(edges.end(), {norm(p(1) - p(0)), norm(p(2) - p(1)), norm(p(0) - p(2))});
  }
  if (triangle_.empty())
    return;
  edge_ = std::max(typical(edges), 1e-300);
  spacing_ = 0.8 * edge_; // a dual-contouring surface has edges of 1.2 h
  sort_along_curve();
  tree_ = std::make_unique<BoxTree>(
      triangle_.size(), [&](size_t t) { return box_around(triangle_[t].a, triangle_[t].b, triangle_[t].c); });
  const size_t samples = std::min<size_t>(64, triangle_.size());
  int64_t all = 0;
  for (size_t s = 0; s < samples; ++s) {
    const Triangle& t = triangle_[s * triangle_.size() / samples];
    Vec3d q;
    int looked_at;
    closest((t.a + t.b + t.c) / 3., 0.5 * edge_, q, looked_at);
    all += looked_at;
  }
  looks_ += 8 * all / static_cast<int64_t>(samples);
}

void ReferenceSurface::sort_along_curve() {
  const auto middle = [](const Triangle& t) { return (t.a + t.b + t.c) / 3.; };
  Vec3d low = middle(triangle_[0]), high = low;
  for (const Triangle& t : triangle_)
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], middle(t)[a]);
      high[a] = std::max(high[a], middle(t)[a]);
    }
  const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
  constexpr double places = (1 << 21) - 1; // of the curve, along each axis
  std::vector<std::pair<uint64_t, Triangle>> sorted;
  for (const Triangle& t : triangle_) {
    const Vec3d place = places / extent * (middle(t) - low);
    const auto at = [](double x) { return static_cast<int32_t>(x); };
    sorted.emplace_back(morton({at(place.x), at(place.y), at(place.z)}), t);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t t = 0; t < sorted.size(); ++t)
    triangle_[t] = sorted[t].second;
}

/// Answers at places where many triangles are near: the same place is asked for again and again.
struct ReferenceSurface::Answer {
  uint64_t surface = 0; ///< its number; 0: none
  Vec3d from, point;
  double reach = 0;
  const Triangle* nearest = nullptr;
};

ReferenceSurface::Answer& ReferenceSurface::kept_answer(Vec3d p, double reach) {
  constexpr int bits = 14;
  thread_local std::vector<Answer> kept(size_t{1} << bits);
  uint64_t h = 0;
  for (const double x : {p.x, p.y, p.z, reach})
    h = (h ^ std::bit_cast<uint64_t>(x)) * 0x9E3779B97F4A7C15u, h ^= h >> 29;
  return kept[h * 0xFF51AFD7ED558CCDu >> (64 - bits)];
}

const ReferenceSurface::Triangle* ReferenceSurface::closest(Vec3d p, double reach, Vec3d& point,
                                                            int& looked_at) const {
  looked_at = 0; // a kept answer takes none
  const bool many = many_.load(std::memory_order_relaxed);
  if (many) {
    const Answer& a = kept_answer(p, reach);
    if (a.surface == number_ && a.from == p && a.reach == reach) {
      if (a.nearest)
        point = a.point;
      return a.nearest;
    }
  }
  double best = reach * reach;
  const double rounding = 1e-9 * best + 1e-20 * edge_ * edge_;
  const Triangle* nearest = nullptr;
  if (tree_)
    tree_->near(p, best, [&](size_t i) {
      const Triangle& t = triangle_[i];
      if (++looked_at > all_looked_at)
        return -1.;
      const double off = dot(p - t.a, t.normal); // from its plane, of which no place is nearer
      if (off * off > best + rounding)
        return best;
      const Vec3d q = closest_on(t.a, t.b, t.c, p);
      const double d = norm2(q - p);
      if (d < best || (d == best && nearest && t.index < nearest->index))
        best = d, point = q, nearest = &t;
      return best;
    });
  if (looked_at > most_looked_at) {
    many_.store(true, std::memory_order_relaxed);
    kept_answer(p, reach) = {number_, p, nearest ? point : p, reach, nearest};
  }
  return nearest;
}

bool ReferenceSurface::project(Vec3d& p, double reach) const {
  const Vec3d from = p;
  int looked_at;
  return closest(from, std::min(reach, edge_), p, looked_at) != nullptr;
}

bool ReferenceSurface::probe(Vec3d p, double& distance, Vec3d& normal) const {
  Vec3d q;
  int looked_at;
  const Triangle* t = closest(p, 0.5 * edge_, q, looked_at);
  if (!t)
    return false;
  normal = t->normal;
  const double length = norm(p - q);
  distance = dot(p - q, normal) < 0 ? -length : length;
  return true;
}

} // namespace molmesh
