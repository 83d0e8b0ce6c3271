// face_shape.hpp — decides whether a face gets a point: where the dual edge misses it, or where its elements are
// flat. Host and device.
#pragma once
#include "contour/complex/edge_crossing.hpp"
#include "contour/elements/least_sine.hpp"
#include "geom/tet_measures.hpp"
#include <cmath>

namespace molmesh::contour {

/// A convex polygon of vertices of the complex, counter-clockwise seen from the cell in front.
struct Polygon {
  static constexpr int most = 8;
  int n = 0;
  int32_t vertex[most];
  MOLMESH_HD void add(int32_t v) { vertex[n++] = v; }
  MOLMESH_HD int next(int i) const { return i + 1 < n ? i + 1 : 0; }
};

/// Volumes below this share of the cube of the face's shortest edge get a face point instead.
inline constexpr double least_volume = 0.003;

/// The same between boxes of one size, whose grid points may have moved.
inline constexpr double least_moved_volume = 1e-4;

/// Elements with a smaller sine of a dihedral angle (14.5° or 165.5°) get a face point if that makes them better.
inline constexpr double flat_sine = 0.25;

/// least: a share as above; negative: no test.
MOLMESH_HD inline bool pierced(const ComplexView& c, const Polygon& p, int32_t behind, int32_t front,
                               double least_share) {
  if (least_share < 0)
    return true;
  const Vec3d d = c.position[behind], e = c.position[front];
  double size2 = 1e300;
  for (int i = 0; i < p.n; ++i)
    size2 = lesser(size2, norm2(c.position[p.vertex[i]] - c.position[p.vertex[p.next(i)]]));
  const double least = 6 * least_share * size2 * std::sqrt(size2);
  for (int i = 0; i < p.n; ++i)
    if (six_volume(c.position[p.vertex[i]], c.position[p.vertex[p.next(i)]], d, e) < least)
      return false;
  return true;
}

/// The least sine of the elements without a face point, and with one.
MOLMESH_HD inline double direct_shape(const ComplexView& c, const Polygon& p, int32_t behind, int32_t front) {
  double of[Polygon::most];
  least_sines(
      p.n,
      [&](int i, int k) {
        return c.position[k == 0 ? p.vertex[i] : k == 1 ? p.vertex[p.next(i)] : k == 2 ? behind : front];
      },
      of);
  double least = 1;
  for (int i = 0; i < p.n; ++i)
    least = lesser(least, of[i]);
  return least;
}
MOLMESH_HD inline double via_shape(const ComplexView& c, const Polygon& p, int32_t behind, Vec3d via,
                                   int32_t front) {
  double of[2 * Polygon::most]; // two by two, behind and in front
  least_sines(
      2 * p.n,
      [&](int i, int k) {
        const bool is_via = k == (i % 2 ? 2 : 3);
        return is_via   ? via
               : k == 0 ? c.position[p.vertex[i / 2]]
               : k == 1 ? c.position[p.vertex[p.next(i / 2)]]
                        : c.position[k == 2 ? behind : front];
      },
      of);
  double least = 1;
  for (int i = 0; i < p.n; ++i)
    least = lesser(least, lesser(of[2 * i], of[2 * i + 1]));
  return least;
}

/// A point within the polygon: the middle of the surface's trace on it, or the polygon's centre.
MOLMESH_HD inline Vec3d face_point(const ComplexView& c, const Polygon& p) {
  Vec3d crossed, all;
  int crossings = 0;
  for (int i = 0; i < p.n; ++i) {
    const int32_t a = p.vertex[i], b = p.vertex[p.next(i)];
    all += c.position[a];
    if (c.inside(a) == c.inside(b))
      continue;
    crossed += crossing(c, a, b);
    ++crossings;
  }
  return crossings ? crossed / double(crossings) : all / double(p.n);
}

/// Whether a point goes between the dual vertices, and where: where they miss the face, and where elements are
/// better for it. test: they could miss it; check: at a surface cell. Direct elements are positive, where checked
/// by far.
MOLMESH_HD inline bool wants_point(const ComplexView& c, const Polygon& p, int32_t behind, int32_t front, bool test,
                                   bool check, Vec3d& point) {
  const bool direct = pierced(c, p, behind, front, test ? least_volume : check ? least_moved_volume : -1);
  const double shape = !direct ? -1 : test && check ? direct_shape(c, p, behind, front) : 1;
  if (shape >= flat_sine)
    return false;
  point = face_point(c, p);
  return !direct || via_shape(c, p, behind, point, front) > shape;
}

} // namespace molmesh::contour
