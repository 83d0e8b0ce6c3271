// move_vertex.hpp — one vertex looks for the place where its worst element is best. Host and device.
#pragma once
#include "contour/detail/relax_items.hpp"
#include "improve/search.hpp"
#include <cmath>

namespace molmesh::contour::detail {

/// Of a surface vertex, y moves towards the surface, within the walls it lies on, until it is no farther than
/// `most`.
template <class Surface>
HD bool to_surface(const Surface& surface, const Bounds& bound, int32_t vertex, double most, Vec3d& y) {
  constexpr double least_normal = 0.25; // square of the normal's part within a wall
  double distance;
  Vec3d normal;
  if (!surface.probe(y, distance, normal))
    return false;
  if (std::fabs(distance) <= most)
    return true;
  for (int a = 0; a < 3; ++a)
    if (bound.on_wall(vertex, a))
      normal[a] = 0;
  const double along = norm2(normal);
  y -= (distance - (distance < 0 ? -most : most)) / along * normal;
  return along > least_normal;
}

/// most_distance: of a surface vertex from the surface, in its spacings, if it was nearer. Star, of candidate c:
/// spokes(), what improve::pattern_search asks; length(), the mean of its edges at the vertex; and take(x, worst),
/// which puts the vertex there unless an element is no better than `worst`, in double precision, or not positive by
/// the exact predicate.
template <class Surface, class Star>
HD bool move_vertex(const RelaxView& r, const Surface& surface, double most_distance, int32_t c, Star& star) {
  const int32_t vertex = r.vertex[c];
  Vec3d x = r.e.position[vertex];
  const bool on_surface = r.bound.on_surface(vertex);
  Vec3d axis[3];
  int axes = 0;
  for (int a = 0; a < 3; ++a)
    if (!r.bound.on_wall(vertex, a))
      axis[axes++][a] = 1;
  double most = 0; // from the surface
  if (on_surface) {
    Vec3d normal;
    if (!surface.probe(x, most, normal))
      return false;
    most = std::fabs(most);
    most = most < most_distance * surface.spacing() ? most_distance * surface.spacing() : most;
  }
  const auto constrain = [&](Vec3d& y) { return !on_surface || to_surface(surface, r.bound, vertex, most, y); };
  const auto accept = [](const Vec3d&) { return true; };
  float best = r.worst[c];
  return improve::pattern_search(star.spokes(), x, best, r.goal, star.length(), axis, axes, constrain, accept) &&
         star.take(x, r.worst[c]);
}

} // namespace molmesh::contour::detail
