// vertex_smoothing.cpp — a vertex moves to where its worst element is best, or its surface triangles fit best.
#include "optimize/operations/moving_vertex.hpp"
#include <algorithm>
#include <array>

namespace molmesh::optimize {
namespace {

// The best place on the target around x where the surface fits better. The way along the gradient alone leads
// nowhere where that vanishes.
bool place_on_target(Region& r, const Acceptance& accept, const Vertex& vertex, Vec3d& x, double length,
                     const Fit& before, float above) {
  StarQuality& elements = r.work.elements;
  const Vec3d from = x;
  float best = above;
  const OnTarget on_target{r, vertex, from, accept.guard.reach * length};
  const auto fits = [&](Vec3d y) { return fits_at(r, accept, y, before); };
  constexpr int all = 27 * 3; // directions, each at three lengths
  for (int first = 0; first < all; first += 8) {
    const int n = std::min(8, all - first);
    std::array<Vec3d, 8> place;
    for (int i = 0; i < n; ++i) {
      const int way = (first + i) / 3;
      const Vec3d d{way / 9 - 1., way / 3 % 3 - 1., way % 3 - 1.};
      place[i] = from + 0.15 * (1 << (first + i) % 3) * length / std::max(norm(d), 1.) * d;
    }
    const auto there = place.begin() + on_target.all(place.data(), n);
    const auto near = std::remove_if(place.begin(), there, [&](Vec3d y) { return !(norm(y - from) < length); });
    const auto places = static_cast<int>(near - place.begin());
    float q;
    for (int i = 0; (i = elements.first_above(place.data(), i, places, best, q)) < places; ++i)
      if (fits(place[i]))
        best = q, x = place[i];
  }
  if (!(best > above))
    return false;
  Vec3d basis[3];
  const int dimensions = directions_of(r, vertex, false, x, basis);
  pattern_search(elements, x, best, accept.goal, length, basis, dimensions, on_target, fits);
  return true;
}

bool move_to_best(Region& r, const Acceptance& accept, int32_t v) {
  DynamicMesh& m = r.mesh;
  std::vector<int32_t>& star = r.work.star;
  const Vertex& vertex = m.vertex[v];
  if (vertex.kind == Kind::fixed || !r.star(v, star))
    return false;
  const float before = r.worst(star), above = accept.fits_surface() ? accept.demand(before) : before;
  if (!accept.fits_surface() && before >= accept.goal)
    return false;
  r.work.elements.clear(m.point[v]);
  for (const int32_t t : star) {
    const Element& e = m.element[t];
    std::array<Vec3d, 4> p;
    for (size_t j = 0; j < 4; ++j)
      p[j] = m.point[e.v[j]];
    r.work.elements.add(p, e.find(v));
  }
  const double length = mean_edge(r, star, v);
  const Fit fit = gather_triangles(r, accept, star, v);
  if (accept.fits_surface() && fit.excess == 0)
    return false;
  const Vec3d from = m.point[v];
  Vec3d x = from;
  float best = accept.fits_surface() ? fit.worth() : before;
  if (accept.fits_surface() && off(r, v) > 1
          ? !place_on_target(r, accept, vertex, x, length, fit, above)
          : !search_place(r, accept, vertex, x, best, accept.goal, length, fit, above))
    return false;
  m.point[v] = x;
  return accept_move(r, accept, star, v, from, above, deficit_of(r, accept, star));
}

} // namespace

bool smooth_vertex(Region& r, const Acceptance& accept, int32_t v) {
  return r.unless_failed(accept, {.a = v}, [&] { return move_to_best(r, accept, v); });
}

} // namespace molmesh::optimize
