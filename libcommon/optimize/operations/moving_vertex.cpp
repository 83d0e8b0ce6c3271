// moving_vertex.cpp — pattern search along what the vertex is bound to, and the test of its star at the new place.
#include "optimize/operations/moving_vertex.hpp"
#include "geom/tet_quality_simd.hpp"
#include "optimize/acceptance/sag.hpp"
#include <algorithm>
#include <utility>

namespace molmesh::optimize {

float deficit_of(const Region& r, const Acceptance& accept, const std::vector<int32_t>& elements) {
  float sum = 0;
  for (const int32_t e : elements)
    sum += accept.deficit_of(r.mesh.element[e].q);
  return sum;
}

float deficit_of(const Acceptance& accept, const std::vector<Candidate>& elements) {
  float sum = 0;
  for (const Candidate& c : elements)
    sum += accept.deficit_of(c.q);
  return sum;
}

double mean_edge(const Region& r, const std::vector<int32_t>& star, int32_t v) {
  const Vec3d from = r.mesh.point[v];
  double length = 0;
  for (const int32_t t : star)
    for (const int32_t w : r.mesh.element[t].v)
      if (w != v)
        length += norm(r.mesh.point[w] - from);
  return length / (3. * double(star.size()));
}

namespace {

/// The plane across the normal, as an orthonormal basis.
int plane_across(Vec3d normal, Vec3d basis[3]) {
  Vec3d other{1, 0, 0};
  if (std::abs(normal.x) > 0.6)
    other = {0, 1, 0};
  basis[0] = cross(normal, other);
  basis[0] = basis[0] / norm(basis[0]);
  basis[1] = cross(normal, basis[0]);
  return 2;
}

} // namespace

int directions_of(const Region& r, const Vertex& vertex, bool leaves_target, Vec3d x, Vec3d basis[3]) {
  const Target* target = r.target_of(vertex.label);
  int n = 0;
  if (vertex.kind == Kind::fixed)
    return 0;
  if (vertex.kind == Kind::round)
    return plane_across((x - r.mesh.sphere.center) / norm(x - r.mesh.sphere.center), basis);
  if (!follows_target(vertex.kind) || (leaves_target && target)) {
    for (int a = 0; a < 3; ++a)
      if (!(vertex.frozen >> a & 1))
        basis[n] = {}, basis[n++][a] = 1;
    return n;
  }
  double distance;
  Vec3d normal;
  if (!target || !target->probe(x, distance, normal))
    return 0;
  if (vertex.kind == Kind::trace || vertex.kind == Kind::line) {
    Vec3d across;
    if (vertex.kind == Kind::trace)
      across[vertex.axis()] = 1;
    else if (!r.target_of(vertex.second)->probe(x, distance, across))
      return 0;
    basis[0] = cross(across, normal);
    const double length = norm(basis[0]);
    if (!(length > 0))
      return 0;
    basis[0] = basis[0] / length;
    return 1;
  }
  return plane_across(normal, basis);
}

float worth_at(Region& r, const Acceptance& accept, Vec3d x, float above) {
  return r.work.elements.worst(x, above) > above ? fit_of_triangles(r, accept, &x).worth() : 0;
}

bool search_place(Region& r, const Acceptance& accept, const Vertex& vertex, Vec3d& x, float& best, float aim,
                  double length, const Fit& before, float above) {
  Vec3d basis[3];
  const int dimensions = directions_of(r, vertex, accept.guard.lift > 0 || accept.off_target, x, basis);
  if (dimensions == 0)
    return false;
  constexpr size_t places = 128; // about
  r.looks.done += static_cast<int64_t>(places * r.work.elements.size());
  if (const Target* target = r.target_of(vertex.label); target && follows_target(vertex.kind))
    r.look_at(*target, places);
  const Bound bound{accept, {r, vertex, x, accept.guard.reach * length}};
  if (accept.fits_surface()) {
    struct {
      Region& r;
      const Acceptance& accept;
      float above;
      float worst(Vec3d y, float) { return worth_at(r, accept, y, above); }
      Vec3d ascent(Vec3d, double) { return {}; }
    } fit{r, accept, above};
    return pattern_search(fit, x, best, 1, length, basis, dimensions, bound, [](Vec3d) { return true; });
  }
  return pattern_search(
      r.work.elements, x, best, aim, length, basis, dimensions, bound,
      [&](Vec3d y) { return fits_at(r, accept, y, before); }, accept.least_step);
}

namespace {

/// Whether the triangles on the sphere at v sag more than they may, and than with v at `from`.
bool sags_more(DynamicMesh& m, const std::vector<int32_t>& star, int32_t v, Vec3d from) {
  const double now = largest_sag(m, star, v);
  if (now <= most_sag)
    return false;
  const Vec3d to = std::exchange(m.point[v], from);
  const double before = largest_sag(m, star, v);
  m.point[v] = to;
  return now > before;
}

} // namespace

bool accept_move(Region& r, const Acceptance& accept, const std::vector<int32_t>& star, int32_t v, Vec3d from,
                 float above, float allowed, Moves* later) {
  DynamicMesh& m = r.mesh;
  std::vector<Candidate>& now = r.work.now;
  const auto refuse = [&] {
    m.point[v] = from;
    return false;
  };
  const bool on_surface = follows_target(m.vertex[v].kind);
  if (on_surface && !r.inside_walls(from, m.point[v]))
    return refuse();
  if (m.vertex[v].kind == Kind::round && sags_more(m, star, v, from))
    return refuse();
  now.clear();
  const auto corner = [&](size_t k, size_t i) { return m.point[m.element[star[k]].v[i]]; };
  const auto keep = [&](size_t k, float q) {
    const Element& e = m.element[star[k]];
    now.push_back({e.v, e.region, q, {}});
    return r.is_above(now.back(), above);
  };
  if (!judge_each(star.size(), corner, keep))
    return refuse();
  r.crossings.clear();
  if (r.crossings.on() && on_surface)
    r.crossings.add_at(star, v, -1);
  if (deficit_of(accept, now) > allowed)
    return refuse();
  r.looked_beyond |= !r.crossings.empty() && !later;
  if (later ? r.crossings.leave_part() : r.crossings.cross(0))
    return refuse();
  if (later) {
    later->vertex(v);
    later->from.push_back(from);
    later->face.insert(later->face.end(), r.crossings.faces().begin(), r.crossings.faces().end());
  } else {
    r.crossings.note_moved();
  }
  for (size_t i = 0; i < star.size(); ++i) {
    Element& e = m.element[star[i]];
    e.q = now[i].q;
    r.note_change(star[i]);
    r.touch(star[i]);
  }
  r.changed.insert(r.changed.end(), star.begin(), star.end());
  return r.done(&Counts::moves, "move");
}

bool step_towards(Region& r, const Acceptance& accept, int32_t v, Vec3d to, double shorter, double least,
                  float above, Moves* later) {
  const Vec3d from = r.mesh.point[v];
  for (double step = 1; step > least; step *= shorter) {
    r.mesh.point[v] = step == 1 ? to : from + step * (to - from);
    if (accept_move(r, accept, r.work.star, v, from, above, 1e30f, later))
      return true;
  }
  return false;
}

} // namespace molmesh::optimize
