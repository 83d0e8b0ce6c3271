// move_vertex.hpp — moves one vertex to the place where its worst element is best. Host and device.
#pragma once
#include "contour/relaxation/relax_items.hpp"
#include "geom/pattern_search.hpp"
#include "isosurface/probe_simd.hpp"
#include <cmath>

namespace molmesh::contour {

/// What a vertex of the surface is bound to: y moves towards the surface, within the walls that the vertex lies on,
/// until it is no farther than `most` (Å). As pattern_search needs it.
template <class Surface>
struct NearSurface {
  const Surface& surface;
  const Bounds& bound;
  int32_t vertex;
  bool on_surface; ///< else it is bound to nothing
  double most;

  MOLMESH_HD bool operator()(Vec3d& y) const {
    double distance;
    Vec3d normal;
    return !on_surface || (surface.probe(y, distance, normal) && pull(distance, normal, y));
  }
  int all(Vec3d* y, int n) const requires ProbesEight<Surface> {
    if (!on_surface)
      return n;
    int allowed = 0;
    for (int first = 0; first < n; first += 8) {
      const int count = n - first < 8 ? n - first : 8;
      EightPlaces eight;
      for (int i = 0; i < count; ++i)
        eight.set(static_cast<size_t>(i), y[first + i]);
      EightProbes probes;
      surface.probe_eight(eight, count, probes);
      for (size_t i = 0; i < static_cast<size_t>(count); ++i)
        if (Vec3d p = eight[i]; probes.is_known(i) && pull(probes.distance[i], probes.normal[i], p))
          y[allowed++] = p;
    }
    return allowed;
  }

private:
  MOLMESH_HD bool pull(double distance, Vec3d normal, Vec3d& y) const {
    constexpr double least_normal = 0.25; // square of the normal's component within a wall
    if (std::fabs(distance) <= most)
      return true;
    for (int a = 0; a < 3; ++a)
      if (bound.on_wall(vertex, a))
        normal[a] = 0;
    const double along = norm2(normal);
    y -= (distance - (distance < 0 ? -most : most)) / along * normal;
    return along > least_normal;
  }
};

/// NearSurface where a star's team tests many places at once.
template <class Surface, class Star>
struct NearSurfaceByTeam {
  const NearSurface<Surface>& one;
  const Star& star;
  MOLMESH_HD bool operator()(Vec3d& y) const { return one(y); }
  MOLMESH_HD int all(Vec3d* y, int n) const { return one.on_surface ? star.constrain_all(one, y, n) : n; }
};

/// most_distance: of a surface vertex from the surface, in its spacings, if it was nearer. Star, of candidate c:
/// star_quality(), which pattern_search needs; length(), the mean of its edges at the vertex; and take(x, worst),
/// which puts the vertex there unless an element is no better than `worst`, in double precision, or not positive by
/// the exact predicate; it may have constrain_all(constrain, y, n), as pattern_search's constrain.all.
template <class Surface, class Star>
MOLMESH_HD bool move_vertex(const RelaxView& r, const Surface& surface, double most_distance, int32_t c,
                            Star& star) {
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
  const NearSurface<Surface> constrain{surface, r.bound, vertex, on_surface, most};
  const auto accept = [](const Vec3d&) { return true; };
  float best = r.worst[c];
  const auto search = [&](const auto& bound) {
    return pattern_search(star.star_quality(), x, best, r.goal, star.length(), axis, axes, bound, accept);
  };
  bool moves = false;
  if constexpr (requires { star.constrain_all(constrain, &x, 1); })
    moves = search(NearSurfaceByTeam<Surface, Star>{constrain, star});
  else
    moves = search(constrain);
  return moves && star.take(x, r.worst[c]);
}

} // namespace molmesh::contour
