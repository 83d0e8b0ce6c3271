// sign_change_edges.hpp — the elements round one sign-change edge: pyramids over the ring of dual vertices, split
// by the better diagonal or round a crossing point. Section 4.1 of Liao et al. 2013. Host and device.
#pragma once
#include "contour/complex/edge_crossing.hpp"
#include "contour/elements/batch.hpp"
#include "contour/elements/interior_edges.hpp"
#include "geom/predicates.hpp"
#include "geom/tet_measures.hpp"

namespace molmesh::contour {

/// What a ring needs to know of vertices: those of the complex and the face and wall points after them.
struct RingVertices {
  ComplexView complex;
  int32_t complex_vertices;
  const Vec3d* more;   ///< positions after the complex's own
  const int32_t* wall; ///< of those: Boundary of a wall point, 0 otherwise

  MOLMESH_HD Vec3d position(int32_t v) const {
    return v < complex_vertices ? complex.position[v] : more[v - complex_vertices];
  }
  MOLMESH_HD int32_t wall_of(int32_t v) const { return v < complex_vertices ? 0 : wall[v - complex_vertices]; }
};

/// Rings seldom have more than six vertices, and never more than two for each of the twelve cells and pieces that
/// can meet at an edge.
struct Ring {
  static constexpr int most = 32;
  int32_t vertex[most];
  int n = 0;
  bool closed = true, has_via = false, broken = false;
  MOLMESH_HD void add(int32_t v) {
    broken = broken || n == most;
    if (!broken)
      vertex[n++] = v;
  }
};

MOLMESH_HD inline void trace(const Link* begin, const Link* end, Ring& ring) {
  const auto coming_from = [&](int32_t v) {
    const Link* l = begin;
    while (l < end && l->from != v)
      ++l;
    return l;
  };
  const auto is_reached = [&](int32_t v) {
    const Link* l = begin;
    while (l < end && l->to != v)
      ++l;
    return l < end;
  };
  const Link* start = begin;
  for (const Link* l = begin; l < end; ++l)
    if (!is_reached(l->from))
      start = l;
  const Link* link = start;
  for (const Link* l = begin; l < end && link; ++l) {
    ring.add(link->from);
    if (link->via != no_vertex) {
      ring.add(link->via);
      ring.has_via = true;
    }
    const int32_t to = link->to;
    link = coming_from(to);
    if (link == end) {
      ring.add(to);
      link = nullptr;
    }
  }
  ring.closed = link == start;
  ring.broken = ring.broken || (!ring.closed && link);
}

/// Whether one of the splits of a ring of three or four has only elements so far from flat that whatever is chosen
/// has positive volumes: sines of dihedral angles are at least six volumes over the cube of the longest edge.
MOLMESH_HD inline bool clearly_positive(const RingVertices& v, int32_t inside, int32_t outside, const Ring& ring) {
  constexpr double least_sine_of_all = 1e-5;
  const Vec3d a = v.position(inside), b = v.position(outside);
  Vec3d x[4];
  double far2 = norm2(b - a);
  for (int i = 0; i < ring.n; ++i) {
    x[i] = v.position(ring.vertex[i]);
    const double d2 = norm2(x[i] - a);
    far2 = d2 > far2 ? d2 : far2;
  }
  const double least = least_sine_of_all * 8 * far2 * std::sqrt(far2); // no edge is longer than twice the farthest
  const auto good = [&](int i, int j, int k) {
    return six_volume(a, x[i], x[j], x[k]) > least && six_volume(b, x[i], x[k], x[j]) > least;
  };
  if (ring.n == 3)
    return good(0, 1, 2);
  return (good(0, 1, 2) && good(2, 3, 0)) || (good(1, 2, 3) && good(3, 0, 1));
}

/// Elements of the ring with the edge's crossing point at its middle.
template <class Out>
MOLMESH_HD void add_round_point(const RingVertices& v, int32_t a, int32_t b, const Ring& ring, Vec3d m, Out& out) {
  const int k = ring.n;
  const auto p = [&](int i) { return ring.vertex[i % k]; };
  const int32_t middle = out.add_point(m, 0);
  for (int i = 0; i < (ring.closed ? k : k - 1); ++i) {
    out.tet.push_back({a, middle, p(i), p(i + 1)});
    out.tet.push_back({b, middle, p(i + 1), p(i)});
    out.add_triangle({middle, p(i), p(i + 1)}, a, b, surface);
  }
  if (ring.closed)
    return;
  const int32_t first = p(0), last = p(k - 1);
  out.add_triangle({a, middle, last}, a, a, v.wall_of(last));
  out.add_triangle({middle, a, first}, a, a, v.wall_of(first));
  out.add_triangle({middle, b, last}, b, b, v.wall_of(last));
  out.add_triangle({b, middle, first}, b, b, v.wall_of(first));
}

/// links [begin, end): all links of one edge. The ring is closed, or at a wall an open chain from wall point to
/// wall point.
template <class Out>
MOLMESH_HD void make_ring(const RingVertices& v, const Link* begin, const Link* end, Out& out) {
  Ring ring;
  trace(begin, end, ring);
  if (ring.broken)
    return out.broken_ring();
  const int32_t a = begin->inside, b = begin->outside;
  const int k = ring.n;
  const auto p = [&](int i) { return ring.vertex[i % k]; };
  const auto x = [&](int32_t i) { return v.position(i); };
  const bool plain = ring.closed && !ring.has_via && (k == 3 || k == 4);
  if (Out::checks && plain && clearly_positive(v, a, b, ring))
    return;

  // Quality of a split into triangles without a new point: the worst of the tetrahedra on both sides. A ring of
  // four has two splits of two triangles each, t / 2 and t % 2.
  const auto triangle = [&](int t, int i) { return ring.vertex[k == 3 ? i : (t / 2 + 2 * (t % 2) + i) & 3]; };
  Tri split[2] = {};
  int triangles = 0;
  double best = 0;
  if (plain) {
    double sine[8]; // inside and outside of each triangle
    least_sines(
        k == 3 ? 2 : 8,
        [&](int i, int corner) {
          const bool outside = i % 2 != 0;
          if (corner == 0)
            return x(outside ? b : a);
          const int at = corner == 1 || !outside ? corner - 1 : 4 - corner; // outside turns the other way round
          return x(triangle(i / 2, at));
        },
        sine);
    const auto quality_of = [&](int t) { return lesser(sine[2 * t], sine[2 * t + 1]); };
    for (int s = 0; s < (k == 3 ? 1 : 2); ++s) {
      const double quality = k == 3 ? quality_of(0) : lesser(quality_of(2 * s), quality_of(2 * s + 1));
      if (quality <= best)
        continue;
      best = quality;
      triangles = k - 2;
      for (int t = 0; t < triangles; ++t)
        split[t] = {triangle(2 * s + t, 0), triangle(2 * s + t, 1), triangle(2 * s + t, 2)};
    }
  }
  constexpr double good = 0.3; // no point would be better by much
  const Vec3d m = best >= good ? Vec3d{} : crossing(v.complex, a, b);
  double with_point = 1;
  if (triangles > 0 && best < good) {
    double sine[8]; // inside and outside of each of the ring's edges
    least_sines(
        2 * k,
        [&](int i, int corner) {
          return corner == i % 2 ? x(i % 2 ? b : a) : corner < 2 ? m : x(p(i / 2 + corner - 2));
        },
        sine);
    for (int i = 0; i < k; ++i)
      with_point = lesser(with_point, lesser(sine[2 * i], sine[2 * i + 1]));
  }
  if (triangles > 0 && (best >= good || best >= with_point)) {
    if constexpr (!Out::checks)
      for (int t = 0; t < triangles; ++t) {
        const Tri& q = split[t];
        out.tet.push_back({a, q[0], q[1], q[2]});
        out.tet.push_back({b, q[0], q[2], q[1]});
        out.add_triangle(q, a, b, surface);
      }
    return;
  }
  if constexpr (Out::checks) {
    bool positive = true;
    for (int i = 0; i < (ring.closed ? k : k - 1); ++i)
      positive =
          positive && orient3d(x(a), m, x(p(i)), x(p(i + 1))) > 0 && orient3d(m, x(b), x(p(i)), x(p(i + 1))) > 0;
    if (positive)
      return;
    out.spoiled.push_back(a);
    out.spoiled.push_back(b);
    for (int i = 0; i < k; ++i)
      if (p(i) < v.complex_vertices)
        out.spoiled.push_back(p(i));
  } else {
    add_round_point(v, a, b, ring, m, out);
  }
}

} // namespace molmesh::contour
