// edge_split.cpp — a new vertex on an edge, where its elements are best.
#include "optimize/operations/moving_vertex.hpp"
#include <algorithm>

namespace molmesh::optimize {

namespace {

// Whether the edge is of a line between domains.
bool is_line(const Region& r, const Ring& ring) {
  const auto on_line = [&](int32_t v) {
    return r.mesh.vertex[v].kind == Kind::line || r.mesh.vertex[v].kind == Kind::fixed;
  };
  return ring.border.size() == 3 && r.mesh.order.last_domain > molmesh::Region::cavity && on_line(ring.a) &&
         on_line(ring.b) && (r.mesh.vertex[ring.a].kind == Kind::line || r.mesh.vertex[ring.b].kind == Kind::line);
}

bool split(Region& r, const Acceptance& accept, int32_t e, int i, int j) {
  auto& [star, other_star, old, now, ring, elements, triangles] = r.work;
  const int32_t a = r.mesh.element[e].v[i], b = r.mesh.element[e].v[j];
  if (!r.ring(e, a, b, ring))
    return false;
  if (r.room.vertex.empty() || !r.has_room(ring.element.size(), 2 * ring.element.size())) {
    r.looked_beyond = true;
    return false;
  }
  if (r.target && norm(r.mesh.point[a] - r.mesh.point[b]) < 0.3 * r.target->spacing())
    return false;
  Vertex kind;
  if (!ring.border.empty()) {
    const Label& label = r.mesh.labels[ring.label[0]];
    if (is_line(r, ring)) {
      kind = line_vertex(r.mesh, ring.label);
    } else {
      if (ring.border.size() != 2 || ring.label[0] != ring.label[1])
        return false;
      kind.label = ring.label[0];
      kind.kind = label.curved() ? Kind::surface : label.round ? Kind::round : Kind::sliding;
    }
    kind.watched = r.mesh.vertex[a].watched || r.mesh.vertex[b].watched;
    if (kind.kind == Kind::sliding)
      kind.frozen = static_cast<uint8_t>(1 << label.axis);
    if (label.curved() && !r.target)
      return false;
  }
  const float before = r.worst(ring.element), aim = before + 1e-8f + 0.02f * before;
  const float above = accept.fits_surface() ? accept.demand(before) : before;
  now.clear();
  elements.clear(0.5 * (r.mesh.point[a] + r.mesh.point[b]));
  triangles.clear();
  const int32_t v = r.room.vertex.back(), ends[2] = {a, b};
  for (const int32_t t : ring.element) {
    const Element& el = r.mesh.element[t];
    for (const int32_t end : ends) {
      Candidate c{el.v, el.region, 0, el.label};
      c.label[size_t(el.find(a))] = c.label[size_t(el.find(b))] = 0; // one is outer, the other one new
      const int k = el.find(end);
      std::array<Vec3d, 4> p;
      for (size_t n = 0; n < 4; ++n)
        p[n] = r.mesh.point[c.v[n]];
      c.v[k] = v;
      elements.add(p, k);
      now.push_back(c);
      for (size_t f = 0; f < 4; ++f)
        if (el.label[f] != 0 && el.v[f] != a && el.v[f] != b)
          add_triangle(r, el, f, end);
    }
  }
  Fit fit = fit_of_triangles(r, accept);
  fit.excess /= 2; // each triangle goes with either end
  const Vec3d pa = r.mesh.point[a], pb = r.mesh.point[b];
  const double length = norm(pb - pa);
  Vec3d x = 0.5 * (pa + pb);
  if (!Bound{accept, {r, kind, x, accept.guard.reach * length}}(x))
    return false;
  float best = elements.worst(x, 0.25f * before);
  if (!(best > 0.25f * before) || (!accept.fits_surface() && !fits_at(r, accept, x, fit)))
    return false; // too far from a gain to search for it
  if (accept.fits_surface())
    best = worth_at(r, accept, x, above);
  search_place(r, accept, kind, x, best, std::max(accept.goal, aim), length, fit, above);
  if (accept.fits_surface() ? !fits_at(r, accept, x, fit) : best < aim)
    return false;
  if (kind.kind == Kind::surface && !r.mesh.walls.clear(x, apart_from_walls * r.spacing()))
    return false; // the middle may lie in a wall: it sets no measure
  r.mesh.vertex[v] = kind;
  r.mesh.point[v] = x;
  for (Candidate& c : now)
    if (!r.judge(c, above))
      return false;
  if (deficit_of(accept, now) > deficit_of(r, accept, ring.element))
    return false;
  old = ring.element;
  if (!r.exchange(old, now, !ring.border.empty()))
    return false;
  r.room.vertex.pop_back();
  return r.done(&Counts::splits, "edge split");
}

} // namespace

bool split_edge(Region& r, const Acceptance& accept, int32_t e, int i, int j) {
  const auto& v = r.mesh.element[e].v;
  return r.unless_failed(accept,
                         {.operation = FailedAttempts::Operation::split, .a = v[i], .b = v[j], .element = e},
                         [&] { return split(r, accept, e, i, j); });
}

} // namespace molmesh::optimize
