// nearest_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "distance/nearest_simd.hpp"
#include "base/dispatch.hpp"
#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "distance/nearest_simd.cpp"
#include <hwy/foreach_target.h>

#include "geom/double_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::distance {
namespace HWY_NAMESPACE {
namespace {

using molmesh::HWY_NAMESPACE::lanes;
using molmesh::HWY_NAMESPACE::load;
using molmesh::HWY_NAMESPACE::store;
using molmesh::HWY_NAMESPACE::take_root;
using molmesh::HWY_NAMESPACE::V;

constexpr double largest = std::numeric_limits<double>::max();

HWY_INLINE void offset(const Points& p, size_t i, Vec3d from, V& x, V& y, V& z) {
  load(p.x + i, x);
  load(p.y + i, y);
  load(p.z + i, z);
  x -= from.x;
  y -= from.y;
  z -= from.z;
}

HWY_INLINE double smallest_of(const V& v) {
  double least = v[0];
  for (int i = 1; i < lanes; ++i)
    least = std::min<double>(least, v[i]);
  return least;
}

double take_deeper_simd(const Points& p, const Ball& ball, double number, double* depth, double* second,
                        double* deepest) {
  V lowest = V{} + largest;
  for (size_t i = 0; i < p.n; i += lanes) {
    V x, y, z, old, next, best;
    offset(p, i, ball.center, x, y, z);
    load(depth + i, old);
    load(second + i, next);
    load(deepest + i, best);
    V d = x * x + y * y + z * z;
    take_root(d);
    d = ball.radius - d;
    const auto deeper = d > old;
    const V lower = deeper ? old : d, higher = deeper ? d : old;
    store(next > lower ? next : lower, second + i);
    store(deeper ? V{} + number : best, deepest + i);
    store(higher, depth + i);
    lowest = lowest < higher ? lowest : higher;
  }
  return smallest_of(lowest);
}

/// holds(x, y): whether the direction (x, y) lies within the arc.
template <class Holds>
HWY_INLINE double take_nearer_to_circle(const Points& p, const Arc& a, double* d2, Holds&& holds) {
  V highest{};
  for (size_t i = 0; i < p.n; i += lanes) {
    V x, y, z, old;
    offset(p, i, a.middle, x, y, z);
    load(d2 + i, old);
    const V along = x * a.first.x + y * a.first.y + z * a.first.z,
            across = x * a.second.x + y * a.second.y + z * a.second.z,
            up = x * a.axis.x + y * a.axis.y + z * a.axis.z;
    V off = along * along + across * across;
    take_root(off);
    off -= a.radius;
    const V mine = off * off + up * up;
    const auto nearer = holds(along, across) & (mine < old);
    const V best = nearer ? mine : old;
    store(best, d2 + i);
    highest = highest > best ? highest : best;
  }
  return -smallest_of(-highest);
}

double take_nearer_to_arc_simd(const Points& p, const Arc& a, double* d2) {
  const double ex = a.end_x, ey = a.end_y;
  const V zero{};
  if (a.length == Arc::Length::short_arc)
    return take_nearer_to_circle(p, a, d2,
                                 [&](const V& x, const V& y) HWY_ATTR { return (y >= zero) & (x * ey >= y * ex); });
  if (a.length == Arc::Length::long_arc)
    return take_nearer_to_circle(p, a, d2,
                                 [&](const V& x, const V& y) HWY_ATTR { return (y >= zero) | (x * ey >= y * ex); });
  return take_nearer_to_circle(p, a, d2, [&](const V& x, const V&) HWY_ATTR { return x == x; });
}

double take_nearer_to_vertex_simd(const Points& p, Vec3d vertex, double* d2) {
  V highest{};
  for (size_t i = 0; i < p.n; i += lanes) {
    V x, y, z, old;
    offset(p, i, vertex, x, y, z);
    load(d2 + i, old);
    const V mine = x * x + y * y + z * z, best = mine < old ? mine : old;
    store(best, d2 + i);
    highest = highest > best ? highest : best;
  }
  return -smallest_of(-highest);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::distance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::distance {

HWY_EXPORT(take_deeper_simd);
HWY_EXPORT(take_nearer_to_arc_simd);
HWY_EXPORT(take_nearer_to_vertex_simd);

double take_deeper(const Points& p, const Ball& ball, double number, double* depth, double* second,
                   double* deepest) {
  return MOLMESH_DISPATCH(take_deeper_simd)(p, ball, number, depth, second, deepest);
}
double take_nearer(const Points& p, const Arc& arc, double* d2) {
  return MOLMESH_DISPATCH(take_nearer_to_arc_simd)(p, arc, d2);
}
double take_nearer(const Points& p, Vec3d vertex, double* d2) {
  return MOLMESH_DISPATCH(take_nearer_to_vertex_simd)(p, vertex, d2);
}

} // namespace molmesh::distance
#endif
