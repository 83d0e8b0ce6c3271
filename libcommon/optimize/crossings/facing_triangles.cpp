// facing_triangles.cpp — boxes of triangles, widened by what they may move, that meet.
#include "optimize/crossings/facing_triangles.hpp"
#include "mesh/box_tree.hpp"
#include "par/choose.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {
namespace {

// Where so many boxes meet one, as at the edge of a fan, the triangle counts as facing another: to look at all of
// them takes time that grows with their square.
constexpr int most_looked_at = 1024;

// Whether b has a corner before the plane of a, or hardly behind it. Triangles that face away from each other
// have elements between them, which keep them apart.
bool reaches_before(const std::vector<Vec3d>& point, const FreeTriangle& a, const FreeTriangle& b, double hardly) {
  const Vec3d normal{double(a.normal.x), double(a.normal.y), double(a.normal.z)};
  return std::any_of(b.v.begin(), b.v.end(),
                     [&](int32_t v) { return dot(normal, point[v] - point[a.v[0]]) > -hardly; });
}

// How far off the target triangles are, at their centroids and the middles of their edges (Å). A spacing where that
// is not known, and at most: what is farther is so to first order alone.
std::vector<float> deviations(const std::vector<Vec3d>& point, const std::vector<FreeTriangle>& triangle,
                              const Target& target, int threads) {
  std::vector<float> off(triangle.size());
  par::for_n(static_cast<int64_t>((triangle.size() + 1) / 2), threads, [&](int64_t pair) {
    const auto first = size_t(2 * pair), end = std::min(triangle.size(), first + 2);
    EightPlaces place;
    for (size_t t = first; t < end; ++t) {
      const auto at = [&](size_t i) { return point[triangle[t].v[i]]; };
      const size_t k = 4 * (t - first);
      place.set(k, (at(0) + at(1) + at(2)) / 3.);
      for (size_t i = 0; i < 3; ++i)
        place.set(k + 1 + i, 0.5 * (at(i) + at((i + 1) % 3)));
    }
    EightProbes probes;
    target.probe_eight(place, static_cast<int>(4 * (end - first)), probes);
    for (size_t t = first; t < end; ++t)
      for (size_t k = 4 * (t - first); k < 4 * (t - first) + 4; ++k) {
        const double most = target.spacing(), distance = probes.is_known(k) ? std::fabs(probes.distance[k]) : most;
        off[t] = std::max(off[t], static_cast<float>(std::min(distance, most)));
      }
  });
  return off;
}

} // namespace

std::vector<FreeTriangle> find_free_triangles(const DynamicMesh& m, int threads) {
  const auto ends = [&](const Element& e, size_t f) { return e.n[f] < 0 && m.labels[e.label[f]].curved(); };
  const std::vector<int32_t> element = par::choose(
      static_cast<int64_t>(m.element.size()), threads, DynamicMesh::chunk,
      [&](int64_t s) { return m.labelled[s] != 0; },
      [&](int64_t t) {
        const Element& e = m.element[t];
        return e.alive() && (ends(e, 0) || ends(e, 1) || ends(e, 2) || ends(e, 3));
      });
  std::vector<FreeTriangle> triangle;
  triangle.reserve(element.size()); // few elements have two
  for (const int32_t t : element)
    for (size_t f = 0; f < 4; ++f)
      if (const Element& e = m.element[t]; ends(e, f))
        triangle.push_back(free_triangle(m.point, outward_triangle(e.v, f), 4 * int64_t{t} + int64_t(f)));
  return triangle;
}

double cell_for(const std::vector<FreeTriangle>& triangles) {
  if (triangles.empty())
    return 1;
  std::vector<float> size;
  for (const FreeTriangle& t : triangles) {
    const Vec3f d = t.high - t.low;
    size.push_back(std::max({d.x, d.y, d.z}));
  }
  const auto median = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
  std::nth_element(size.begin(), median, size.end());
  return 3. * double(*median);
}

std::vector<uint8_t> facing(const std::vector<Vec3d>& point, const std::vector<FreeTriangle>& triangle,
                            const Target& target, const FacingDistance& distance, int threads) {
  const std::vector<float> off =
      distance.none_is_off ? std::vector<float>(triangle.size()) : deviations(point, triangle, target, threads);
  const auto kept = static_cast<float>(distance.kept);
  const auto widened = [&](size_t n, double by) {
    const float reach = static_cast<float>(by) + off[n] + std::max(0.f, off[n] - kept);
    FreeTriangle wide = triangle[n];
    wide.low = wide.low - Vec3f{reach, reach, reach};
    wide.high = wide.high + Vec3f{reach, reach, reach};
    return wide;
  };
  const BoxTree tree(
      triangle.size(), [&](size_t n) { return widened(n, 0); }, threads);
  const double hardly = target.spacing() / 4;
  std::vector<uint8_t> faces(triangle.size());
  par::for_n(static_cast<int64_t>(triangle.size()), threads, [&](int64_t t) {
    const FreeTriangle wide = widened(size_t(t), distance.apart);
    int looked_at = 0;
    faces[t] = tree.any(wide, [&](size_t n) {
      if (++looked_at > most_looked_at)
        return true;
      const FreeTriangle& other = triangle[n];
      return !wide.runs_alike(other, false) && reaches_before(point, wide, other, hardly) &&
             reaches_before(point, other, wide, hardly);
    });
  });
  return faces;
}

} // namespace molmesh::optimize
