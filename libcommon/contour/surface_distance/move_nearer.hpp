// move_nearer.hpp — moves one vertex to where its surface triangles are nearer to the isosurface. Host and device.
#pragma once
#include "contour/relaxation/move_vertex.hpp"
#include "contour/surface_distance/nearer_items.hpp"

namespace molmesh::contour {

/// The surface triangles at a vertex that moves.
class TriangleFan {
public:
  static constexpr int64_t most = 24;

  /// Of candidate c, which has `most` triangles at most.
  template <class Surface>
  MOLMESH_HD TriangleFan(const NearerView& v, const Surface& surface, int32_t c)
      : triangle_(v.triangle + v.first[c]), n_(v.first[c + 1] - v.first[c]), x_(v.r.e.position[v.r.vertex[c]]),
        spacing_(surface.spacing()) {
    for (int64_t k = 0; k < n_; ++k) {
      const int32_t t = triangle_[k];
      for (const int32_t other : v.r.e.tri[t])
        if (other != v.r.vertex[c])
          rest_[k] += v.r.e.position[other];
      off_[k] = v.off[t];
      double distance;
      known_[k] = surface.probe(centroid(k, x_), distance, normal_[k]);
      if (!known_[k])
        continue;
      distance_[k] = distance < 0 ? -off_[k] : off_[k];
      cost_ += CentroidDistance::cost(off_[k]);
      if (off_[k] > CentroidDistance::least)
        way_ += (distance < 0 ? off_[k] - CentroidDistance::least : CentroidDistance::least - off_[k]) * normal_[k];
    }
  }
  MOLMESH_HD double cost() const { return cost_; }
  MOLMESH_HD Vec3d way() const { return way_; } ///< along which the cost falls fastest

  /// The cost with the vertex at y, to first order; `enough` where it is that or more, or a triangle gets out.
  MOLMESH_HD double expected(Vec3d y, double enough) const {
    double sum = 0;
    for (int64_t k = 0; k < n_; ++k) {
      if (!known_[k])
        continue;
      const auto off = static_cast<float>(std::fabs(distance_[k] + dot(normal_[k], y - x_) / (3 * spacing_)));
      sum += CentroidDistance::cost(off);
      if (gets_out(k, off) || sum >= enough)
        return enough;
    }
    return sum;
  }
  /// How far the triangles are off with the vertex at y. False where they cost `enough` or one gets out.
  template <class Surface>
  MOLMESH_HD bool measure(const Surface& surface, Vec3d y, double enough, float* off) const {
    double sum = 0;
    for (int64_t k = 0; k < n_; ++k) {
      off[k] = CentroidDistance::of(surface, centroid(k, y));
      sum += known_[k] ? CentroidDistance::cost(off[k]) : 0;
      if (gets_out(k, off[k]) || sum >= enough)
        return false;
    }
    return true;
  }
  MOLMESH_HD void keep(const NearerView& v, const float* off) const {
    for (int64_t k = 0; k < n_; ++k)
      v.off[triangle_[k]] = off[k];
  }

private:
  /// No triangle that was near becomes far, and none that is far gets farther.
  MOLMESH_HD bool gets_out(int64_t k, float off) const { return off > CentroidDistance::most && off > off_[k]; }
  MOLMESH_HD Vec3d centroid(int64_t k, Vec3d x) const { return (rest_[k] + x) / 3.; }

  const int32_t* triangle_;
  int64_t n_;
  Vec3d x_;
  double spacing_, cost_ = 0;
  Vec3d way_;
  Vec3d rest_[most]; ///< sum of the corners that stay
  Vec3d normal_[most];
  double distance_[most]; ///< in spacings, as far as off
  float off_[most];
  bool known_[most]; ///< where the field is; the others do not count
};

/// Places for the vertex of a fan, those that promise most first.
class NearerPlaces {
public:
  static constexpr int steps = 4, directions = 14;

  MOLMESH_HD NearerPlaces(const TriangleFan& fan, Vec3d x, double spacing, double enough)
      : fan_(fan), x_(x), spacing_(spacing), enough_(enough) {}
  MOLMESH_HD void try_along(Vec3d direction, double length) {
    constexpr double first = 0.9; // in spacings
    double step = first * spacing_;
    for (int s = 0; s < steps; ++s, step *= 0.5) {
      const Vec3d y = x_ + step / length * direction;
      const double cost = fan_.expected(y, enough_);
      if (cost >= enough_)
        continue;
      int k = n_++;
      for (; k > 0 && cost_[k - 1] > cost; --k) {
        cost_[k] = cost_[k - 1];
        place_[k] = place_[k - 1];
      }
      cost_[k] = cost;
      place_[k] = y;
    }
  }
  MOLMESH_HD int size() const { return n_; }
  MOLMESH_HD const Vec3d& operator[](int k) const { return place_[k]; }
  MOLMESH_HD void clear() { n_ = 0; }

private:
  const TriangleFan& fan_;
  Vec3d x_;
  double spacing_, enough_;
  int n_ = 0;
  double cost_[steps * directions];
  Vec3d place_[steps * directions];
};

/// Of a corner of far triangles. Star: as move_vertex wants it. No element falls below the relaxation's goal, or
/// where one of them is below it, below that one; no vertex goes farther from the isosurface than 0.45 spacings, or
/// than it is.
template <class Surface, class Star>
MOLMESH_HD bool move_nearer(const NearerView& v, const Surface& surface, int32_t c, Star& star) {
  constexpr double most_distance = 0.45, slack = 1.01, least_gain = 0.1;
  const RelaxView& r = v.r;
  const int32_t vertex = r.vertex[c];
  const Vec3d x = r.e.position[vertex];
  double here;
  Vec3d normal;
  if (v.first[c + 1] - v.first[c] > TriangleFan::most || !surface.probe(x, here, normal))
    return false;
  const TriangleFan fan(v, surface, c);
  const double most =
      std::fabs(here) / surface.spacing() < most_distance ? most_distance * surface.spacing() : std::fabs(here);
  const double enough = (1 - least_gain) * fan.cost();
  const float floor = r.worst[c] < r.goal ? r.worst[c] : r.goal;
  const NearSurface<Surface> constrain{surface, r.bound, vertex, true, most};
  NearerPlaces places(fan, x, surface.spacing(), enough);
  const auto look = [&](Vec3d direction) {
    for (int a = 0; a < 3; ++a)
      if (r.bound.on_wall(vertex, a))
        direction[a] = 0;
    if (const double length = norm(direction); length > 1e-6)
      places.try_along(direction, length);
  };
  const auto take_one = [&] {
    for (int k = 0; k < places.size(); ++k) {
      Vec3d y = places[k];
      float off[TriangleFan::most];
      if (constrain(y) && star.star_quality().worst(y, floor) > floor && surface.probe(y, here, normal) &&
          std::fabs(here) <= slack * most && fan.measure(surface, y, enough, off) && star.take(y, floor)) {
        fan.keep(v, off);
        return true;
      }
    }
    return false;
  };
  look(fan.way());
  look(dot(normal, fan.way()) < 0 ? -normal : normal);
  if (take_one())
    return true;
  places.clear();
  for (int a = 0; a < 3; ++a)
    for (const double side : {-1., 1.}) {
      Vec3d axis;
      axis[a] = side;
      look(axis);
    }
  for (int k = 0; k < 8; ++k)
    look({k & 1 ? 1. : -1., k & 2 ? 1. : -1., k & 4 ? 1. : -1.});
  return take_one();
}

/// Or, off the surface, to where its worst element is better.
template <class Surface, class Star>
MOLMESH_HD bool move_nearer_or_make_room(const NearerView& v, const Surface& surface, int32_t c, Star& star) {
  if (v.r.bound.on_surface(v.r.vertex[c]))
    return move_nearer(v, surface, c, star);
  RelaxView better = v.r;
  better.goal = v.room;
  return move_vertex(better, surface, 0, c, star);
}

} // namespace molmesh::contour
