// surface_fit.cpp — triangles and trial places eight at a time.
#include "optimize/acceptance/surface_fit.hpp"
#include "isosurface/reference_surface.hpp"
#include <algorithm>
#include <bit>
#include <cmath>

namespace molmesh::optimize {
namespace {

// How far from the target vertices may be that are not kept on it, in units of off_at().
constexpr double most_off_target = 0.9;

const double widest_tilt = Guard{Guard::widest_unbent}.tilt();

double misfit_within(const Region& r, const Guard& guard, double most_tilt, const Element& e, size_t face) {
  if (!r.target || !r.mesh.labels[e.label[face]].curved())
    return 0;
  std::array<Vec3d, 3> p;
  const auto v = outward_triangle(e.v, face);
  for (size_t i = 0; i < 3; ++i)
    p[i] = r.mesh.point[v[i]];
  if (!r.mesh.outward(e, face))
    std::swap(p[1], p[2]);
  r.look_at(*r.target_of(e.label[face]), 1);
  return misfit(*r.target_of(e.label[face]), guard, most_tilt, p[0], p[1], p[2]);
}

// Onto both targets, by steps along both normals.
bool project_on_both(const Target& first, const Target& second, Vec3d& x, double reach) {
  constexpr double most_alike = 0.95; // of the normals: where they are more, steps lead far away
  const Vec3d from = x;
  for (int step = 0; step < 12; ++step) {
    double d, e;
    Vec3d n, m;
    if (!first.probe(x, d, n) || !second.probe(x, e, m))
      return false;
    if (std::abs(d) < 1e-3 * first.spacing() && std::abs(e) < 1e-3 * second.spacing())
      return norm2(x - from) <= reach * reach;
    const double g = dot(n, m), det = 1 - g * g;
    if (std::abs(g) > most_alike || std::abs(d) > reach || std::abs(e) > reach)
      return false;
    x -= (d - g * e) / det * n + (e - g * d) / det * m;
  }
  return false;
}

} // namespace

std::optional<double> off_at(const DynamicMesh& m, const Target* target, const Vertex& vertex, Vec3d x) {
  double most = 0;
  for (int k = 0; k < (vertex.kind == Kind::line ? 2 : 1); ++k) {
    const uint8_t label = k == 0 ? vertex.label : vertex.second;
    const Target* t = m.labels[label].target ? m.labels[label].target : target;
    double distance;
    Vec3d normal;
    if (!t || !t->probe(x, distance, normal))
      return std::nullopt;
    most = std::max(most, t->off_by(distance));
  }
  return most;
}

double off(const DynamicMesh& m, const Target* target, int32_t v) {
  constexpr double two_spacings = 100; // where the target is not known: it is not near
  if (!follows_target(m.vertex[v].kind) || !target)
    return 0;
  // An interface that came in is only followed: nothing brings points back to it.
  const auto came_in = [&](uint8_t label) {
    return dynamic_cast<const ReferenceSurface*>(m.labels[label].target) != nullptr;
  };
  Vertex vertex = m.vertex[v];
  if (vertex.kind == Kind::line && came_in(vertex.second)) {
    vertex.kind = Kind::surface;
  } else if (vertex.kind == Kind::line && came_in(vertex.label)) {
    vertex.kind = Kind::surface;
    vertex.label = vertex.second;
  }
  return came_in(vertex.label) ? 0 : off_at(m, target, vertex, m.point[v]).value_or(two_spacings);
}

bool is_bent(const Region& r, const Acceptance& accept, int32_t t, size_t face) {
  const Element& e = r.mesh.element[t];
  return r.mesh.counts_here(e, face) &&
         misfit_within(r, accept.guard, std::min(accept.most_tilt, widest_tilt), e, face) > 1;
}

double misfit_of(const Region& r, const Acceptance& accept, uint8_t label, Vec3d a, Vec3d b, Vec3d c) {
  r.look_at(*r.target_of(label), 1);
  return misfit(*r.target_of(label), accept.guard, accept.most_tilt, a, b, c);
}

double misfit_of(const Region& r, const Acceptance& accept, const Element& e, size_t face) {
  return misfit_within(r, accept.guard, accept.most_tilt, e, face);
}

void add_triangle(Region& r, const Element& e, size_t face, int32_t from) {
  if (!r.target || !r.mesh.labels[e.label[face]].curved() || !r.mesh.counts_here(e, face))
    return;
  MovingTriangle t{{}, -1, e.label[face]};
  const auto v = outward_triangle(e.v, face);
  for (size_t i = 0; i < 3; ++i) {
    t.p[i] = r.mesh.point[v[i]];
    if (v[i] == from)
      t.moving = static_cast<int>(i);
  }
  if (!r.mesh.outward(e, face)) {
    std::swap(t.p[1], t.p[2]);
    t.moving = t.moving == 1 ? 2 : t.moving == 2 ? 1 : t.moving;
  }
  r.work.triangles.push_back(t);
}

Fit fit_of_triangles(const Region& r, const Acceptance& accept, const Vec3d* x) {
  const std::vector<MovingTriangle>& all = r.work.triangles;
  Fit fit;
  EightTriangles triangle;
  EightPlaces centroid;
  EightProbes probes;
  for (size_t first = 0, n; first < all.size(); first += n) {
    const Target* target = r.target_of(all[first].label);
    for (n = 1; n < 8 && first + n < all.size() && r.target_of(all[first + n].label) == target;)
      ++n;
    for (size_t i = 0; i < n; ++i) {
      const MovingTriangle& t = all[first + i];
      EightPlaces* const corner[3] = {&triangle.a, &triangle.b, &triangle.c};
      for (size_t k = 0; k < 3; ++k)
        corner[k]->set(i, x && t.moving == static_cast<int>(k) ? *x : t.p[k]);
    }
    centroids(triangle, centroid);
    r.look_at(*target, n);
    target->probe_eight(centroid, static_cast<int>(n), probes);
    double misfit[8];
    misfits(triangle, probes, accept.guard.distance * target->spacing(), accept.most_tilt, misfit);
    for (size_t i = 0; i < n; ++i)
      fit.add(misfit[i]);
  }
  return fit;
}

Fit gather_triangles(Region& r, const Acceptance& accept, const std::vector<int32_t>& star, int32_t v) {
  r.work.triangles.clear();
  if (follows_target(r.mesh.vertex[v].kind))
    for (const int32_t t : star) {
      const Element& e = r.mesh.element[t];
      for (size_t f = 0; f < 4 && e.any_labelled(); ++f)
        if (e.label[f] != 0 && e.v[f] != v)
          add_triangle(r, e, f, v);
    }
  Fit fit = fit_of_triangles(r, accept);
  if (accept.fits_surface())
    fit.excess += std::max(0., off(r, v) - 1);
  return fit;
}

bool project(const Region& r, const Vertex& vertex, Vec3d& x, double reach) {
  const Target* target = r.target_of(vertex.label);
  if (!target)
    return false;
  if (vertex.kind == Kind::line)
    return project_on_both(*target, *r.target_of(vertex.second), x, reach);
  return vertex.kind == Kind::trace ? target->project_in_plane(x, vertex.axis(), reach) : target->project(x, reach);
}

bool OnTarget::operator()(Vec3d& x) const {
  if (vertex.kind == Kind::trace)
    x[vertex.axis()] = from[vertex.axis()];
  return project(r, vertex, x, reach) && r.inside_walls(from, x);
}

int OnTarget::all(Vec3d* x, int n) const {
  int there = 0;
  if (vertex.kind != Kind::surface) {
    for (int i = 0; i < n; ++i)
      if (Vec3d y = x[i]; (*this)(y))
        x[there++] = y;
    return there;
  }
  for (int first = 0; first < n; first += 8) {
    const int count = std::min(8, n - first);
    EightPlaces eight;
    for (int i = 0; i < count; ++i)
      eight.set(size_t(i), x[first + i]);
    for (uint32_t put = r.target_of(vertex.label)->project_eight(eight, count, reach); put; put &= put - 1)
      if (const Vec3d y = eight[std::countr_zero(put)]; r.inside_walls(from, y))
        x[there++] = y;
  }
  return there;
}

// Whether x is as near to the target as the guard wants it.
bool Bound::stays_near(Vec3d x) const {
  if (accept.guard.leave == Guard::anywhere)
    return true;
  for (int k = 0; k < (target.vertex.kind == Kind::line ? 2 : 1); ++k) {
    const Target* t = target.r.target_of(k == 0 ? target.vertex.label : target.vertex.second);
    double distance;
    Vec3d normal;
    if (!(t->probe(x, distance, normal) && std::fabs(distance) <= accept.guard.leave * t->spacing()))
      return false;
  }
  return true;
}

bool Bound::operator()(Vec3d& x) const {
  const auto& [r, vertex, from, reach] = target;
  switch (vertex.kind) {
  case Kind::interior:
    return true;
  case Kind::trace:
    x[vertex.axis()] = from[vertex.axis()];
    [[fallthrough]];
  case Kind::surface:
  case Kind::line:
    // The distance to first order means nothing where the gradient vanishes, and that is where points must leave.
    if (r.target && accept.guard.lift > 0)
      return norm(x - from) <= accept.guard.lift * r.target->spacing() && stays_near(x) && r.inside_walls(from, x);
    if (r.target && accept.off_target)
      return norm(x - from) <= reach && off_at(r, vertex, x).value_or(1) <= most_off_target &&
             r.inside_walls(from, x);
    return target(x);
  case Kind::sliding:
    for (int a = 0; a < 3; ++a)
      if (vertex.frozen >> a & 1)
        x[a] = from[a];
    return true;
  case Kind::round:
    x = r.mesh.sphere.nearest(x);
    return true;
  case Kind::fixed:
    break;
  }
  return false;
}

int Bound::all(Vec3d* x, int n) const {
  const auto& [r, vertex, from, reach] = target;
  int allowed = 0;
  if (vertex.kind != Kind::surface || !r.target || accept.guard.lift > 0) {
    for (int i = 0; i < n; ++i)
      if (Vec3d y = x[i]; (*this)(y))
        x[allowed++] = y;
    return allowed;
  }
  if (!accept.off_target)
    return target.all(x, n);
  for (int first = 0; first < n; first += 8) {
    const int count = std::min(8, n - first);
    EightPlaces eight;
    for (int i = 0; i < count; ++i)
      eight.set(size_t(i), x[first + i]);
    EightProbes probes;
    const Target& own = *r.target_of(vertex.label);
    own.probe_eight(eight, count, probes);
    for (uint32_t known = probes.known; known; known &= known - 1) {
      const auto i = size_t(std::countr_zero(known));
      if (own.off_by(probes.distance[i]) <= most_off_target && norm(eight[i] - from) <= reach &&
          r.inside_walls(from, eight[i]))
        x[allowed++] = eight[i];
    }
  }
  return allowed;
}

} // namespace molmesh::optimize
