// reference_surface.cpp — hashes triangles into grids and finds the closest point of one.
#include "isosurface/reference_surface.hpp"
#include "geom/cell_levels.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh {
namespace {

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
  std::vector<double> edges;
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    if (!take[t])
      continue;
    const auto p = [&](size_t i) { return mesh.point[mesh.tri[t][i]]; };
    const Vec3d n = cross(p(1) - p(0), p(2) - p(0));
    triangle_.push_back({p(0), p(1), p(2), n / std::max(norm(n), 1e-300)});
    edges.insert(edges.end(), {norm(p(1) - p(0)), norm(p(2) - p(1)), norm(p(0) - p(2))});
  }
  if (triangle_.empty())
    return;
  const double edge = typical(edges);
  spacing_ = 0.8 * edge; // a dual-contouring surface has edges of 1.2 h
  cell_ = std::max(edge, 1e-300);
  uint64_t buckets = 16;
  while (buckets < 2 * triangle_.size())
    buckets *= 2;
  mask_ = buckets - 1;
  begin_.assign(buckets + 1, 0);
  const auto each = [&](auto&& f) {
    for (size_t t = 0; t < triangle_.size(); ++t) {
      const Triangle& x = triangle_[t];
      Vec3d low = x.a, high = x.a;
      for (int a = 0; a < 3; ++a) {
        low[a] = std::min({x.a[a], x.b[a], x.c[a]});
        high[a] = std::max({x.a[a], x.b[a], x.c[a]});
      }
      const int level = cell_level(low, high, cell_);
      levels_ |= uint64_t{1} << level;
      cell_range(low, high, cell_size(cell_, level)).for_each([&](int64_t i, int64_t j, int64_t k) {
        f(bucket(cell_key(i, j, k, level)), static_cast<int32_t>(t));
      });
    }
  };
  each([&](uint64_t b, int32_t) { ++begin_[b]; });
  entry_.resize(static_cast<size_t>(par::exclusive_scan(begin_)));
  std::vector<int64_t> next = begin_;
  each([&](uint64_t b, int32_t t) { entry_[next[b]++] = t; });
}

bool ReferenceSurface::closest(Vec3d p, double reach, Vec3d& point, int32_t& triangle) const {
  double best = reach * reach;
  triangle = -1;
  if (triangle_.empty())
    return false;
  const Vec3d wide{reach, reach, reach};
  for_levels(levels_, [&](int level) {
    cell_range(p - wide, p + wide, cell_size(cell_, level)).for_each([&](int64_t i, int64_t j, int64_t k) {
      const uint64_t b = bucket(cell_key(i, j, k, level));
      for (int64_t x = begin_[b]; x < begin_[b + 1]; ++x) {
        const int32_t t = entry_[x];
        const Vec3d q = closest_on(triangle_[t].a, triangle_[t].b, triangle_[t].c, p);
        const double d = norm2(q - p);
        if (d < best || (d == best && triangle >= 0 && t < triangle))
          best = d, point = q, triangle = t;
      }
    });
  });
  return triangle >= 0;
}

bool ReferenceSurface::project(Vec3d& p, double reach) const {
  int32_t t;
  const Vec3d from = p;
  return closest(from, std::min(reach, cell_), p, t);
}

bool ReferenceSurface::probe(Vec3d p, double& distance, Vec3d& normal) const {
  int32_t t;
  Vec3d q;
  if (!closest(p, 0.5 * cell_, q, t))
    return false;
  normal = triangle_[t].normal;
  const double length = norm(p - q);
  distance = dot(p - q, normal) < 0 ? -length : length;
  return true;
}

} // namespace molmesh
