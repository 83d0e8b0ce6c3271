// ring_pass.cpp — pyramids over the ring of a sign-change edge, split by the better diagonal or round a crossing
// point.
#include "contour/detail/ring_pass.hpp"
#include "contour/detail/at.hpp"
#include "error.hpp"
#include "geom/predicates.hpp"
#include "geom/tet_measures.hpp"
#include <algorithm>
#include <array>

namespace molmesh::contour::detail {
namespace {

/// Rings seldom have more than six vertices.
struct Ring {
  std::vector<int32_t> vertex;
  bool closed = true, has_via = false;
};

void trace(const Link* begin, const Link* end, Ring& ring) {
  ring.vertex.clear();
  const Link* start = begin;
  for (const Link* l = begin; l < end; ++l)
    if (std::none_of(begin, end, [l](const Link& o) { return o.to == l->from; }))
      start = l;
  ring.has_via = false;
  const Link* link = start;
  for (const Link* l = begin; l < end && link; ++l) {
    ring.vertex.push_back(link->from);
    if (link->via != no_vertex) {
      ring.vertex.push_back(link->via);
      ring.has_via = true;
    }
    const int32_t to = link->to;
    link = std::find_if(begin, end, [to](const Link& o) { return o.from == to; });
    if (link == end) {
      ring.vertex.push_back(to);
      link = nullptr;
    }
  }
  ring.closed = link == start;
  if (!ring.closed && link)
    fail(Status::failed, "contour: a sign-change edge without a ring");
}

double least_sine(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const DihedralTrig t = dihedral_trig(a, b, c, d);
  const double least = *std::min_element(t.sine, t.sine + 6);
  return six_volume(a, b, c, d) > 0 ? least : -1;
}

} // namespace

void make_ring(const RingVertices& v, const Link* begin, const Link* end, const bool wanted[2], Batch& out) {
  thread_local Ring ring;
  trace(begin, end, ring);
  const int32_t a = begin->inside, b = begin->outside;
  const auto k = static_cast<int64_t>(ring.vertex.size());
  const auto p = [&](int64_t i) { return ring.vertex[at(i % k)]; };
  const auto x = [&](int32_t i) { return v.position[at(i)]; };

  // Quality of a split into triangles without a new point: the worst of the tetrahedra on both sides.
  const auto triangle_quality = [&](Tri t) {
    return std::min(least_sine(x(a), x(t[0]), x(t[1]), x(t[2])), least_sine(x(b), x(t[0]), x(t[2]), x(t[1])));
  };
  std::array<Tri, 2> split{};
  int triangles = 0;
  double best = 0;
  if (ring.closed && !ring.has_via && k == 3) {
    split[0] = {p(0), p(1), p(2)};
    best = triangle_quality(split[0]);
    triangles = best > 0 ? 1 : 0;
  } else if (ring.closed && !ring.has_via && k == 4) {
    for (int64_t s = 0; s < 2; ++s) {
      const Tri first{p(s), p(s + 1), p(s + 2)}, second{p(s + 2), p(s + 3), p(s)};
      const double quality = std::min(triangle_quality(first), triangle_quality(second));
      if (quality <= best)
        continue;
      best = quality;
      split = {first, second};
      triangles = 2;
    }
  }
  const Vec3d m = v.complex.crossing(a, b);
  double with_point = 1;
  if (triangles > 0 && best < 0.3)
    for (int64_t i = 0; i < (ring.closed ? k : k - 1); ++i)
      with_point = std::min(
          {with_point, least_sine(x(a), m, x(p(i)), x(p(i + 1))), least_sine(m, x(b), x(p(i)), x(p(i + 1)))});
  if (triangles > 0 && (best >= 0.3 || best >= with_point)) {
    for (int t = 0; t < triangles; ++t) {
      const Tri& q = split[at(t)];
      if (wanted[1])
        out.tet.push_back({a, q[0], q[1], q[2]});
      if (wanted[0])
        out.tet.push_back({b, q[0], q[2], q[1]});
      out.add_triangle(q, a, b, surface);
    }
    return;
  }
  const auto wall = [&](int32_t i) {
    const auto complex_vertices = static_cast<int64_t>(v.complex.position.size());
    return i < complex_vertices ? 0 : v.wall[at(i - complex_vertices)];
  };
  const int32_t crossing = out.add_point(m, 0);
  bool positive = true;
  for (int64_t i = 0; i < (ring.closed ? k : k - 1); ++i)
    positive =
        positive && orient3d(x(a), m, x(p(i)), x(p(i + 1))) > 0 && orient3d(m, x(b), x(p(i)), x(p(i + 1))) > 0;
  if (!positive) {
    out.spoiled.insert(out.spoiled.end(), {a, b});
    for (int32_t vertex : ring.vertex)
      if (vertex < static_cast<int32_t>(v.complex.position.size()))
        out.spoiled.push_back(vertex);
  }
  for (int64_t i = 0; i < (ring.closed ? k : k - 1); ++i) {
    if (wanted[1])
      out.tet.push_back({a, crossing, p(i), p(i + 1)});
    if (wanted[0])
      out.tet.push_back({b, crossing, p(i + 1), p(i)});
    out.add_triangle({crossing, p(i), p(i + 1)}, a, b, surface);
  }
  if (ring.closed)
    return;
  const int32_t first = p(0), last = p(k - 1);
  if (wanted[1]) {
    out.add_triangle({a, crossing, last}, a, a, wall(last));
    out.add_triangle({crossing, a, first}, a, a, wall(first));
  }
  if (wanted[0]) {
    out.add_triangle({crossing, b, last}, b, b, wall(last));
    out.add_triangle({b, crossing, first}, b, b, wall(first));
  }
}

} // namespace molmesh::contour::detail
