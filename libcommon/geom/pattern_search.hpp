// pattern_search.hpp — finds the place of a vertex where the worst element of its star is best, by pattern search.
// The worst quality is not smooth where two elements tie, so steps are tried, not derived: first along the gradient
// of the worst element, then along a fixed set of directions, with halving step lengths.
#pragma once
#include "geom/vec.hpp"
#include <cmath>

namespace molmesh {

/// Steps under this share of the length are rarely worth their time.
inline constexpr double finest_step = 0.01;

/// Raises best = worth.worst(x) by moving x until it reaches the goal or no step helps. `basis`: up to three
/// orthonormal directions to search. constrain(y) moves a trial onto what the vertex is bound to, or refuses;
/// constrain.all(y, n), where there is one, does so to n trials and puts those not refused in front, in order; it
/// returns how many. accept(y) has the last word. Worth: worst() and ascent() as in StarQuality, and first_above()
/// where that is faster than asking one by one. Steps under `least_step` of the length are not tried. Host and
/// device.
template <class Worth, class Constrain, class Accept>
MOLMESH_HD bool pattern_search(Worth& worth, Vec3d& x, float& best, float goal, double length, const Vec3d* basis,
                               int dimensions, Constrain constrain, Accept accept,
                               double least_step = finest_step) {
  Vec3d direction[14];
  int directions = 0;
  for (int a = 0; a < dimensions; ++a) {
    direction[directions++] = basis[a];
    direction[directions++] = -basis[a];
  }
  if (dimensions == 2)
    for (int k = 0; k < 4; ++k)
      direction[directions++] = std::sqrt(0.5) * ((k & 1 ? 1. : -1.) * basis[0] + (k & 2 ? 1. : -1.) * basis[1]);
  if (dimensions == 3)
    for (int k = 0; k < 8; ++k)
      direction[directions++] = std::sqrt(1. / 3) * ((k & 1 ? 1. : -1.) * basis[0] + (k & 2 ? 1. : -1.) * basis[1] +
                                                     (k & 4 ? 1. : -1.) * basis[2]);
  const auto try_step = [&](Vec3d d, double step) {
    Vec3d y = x + step * d;
    if (!constrain(y))
      return false;
    const float above = best + 1e-9f + 5e-3f * best;
    const float q = worth.worst(y, above);
    if (q <= above || !accept(y))
      return false;
    x = y;
    best = q;
    return true;
  };
  const auto try_directions = [&](double step) {
    if constexpr (requires(float q) { worth.first_above(direction, 0, 14, q, q); }) {
      static_assert(Worth::most_places >= 14);
      Vec3d place[14];
      int places = 0;
      if constexpr (requires { constrain.all(place, places); }) {
        for (int d = 0; d < directions; ++d)
          place[d] = x + step * direction[d];
        places = constrain.all(place, directions);
      } else {
        for (int d = 0; d < directions; ++d)
          if (place[places] = x + step * direction[d]; constrain(place[places]))
            ++places;
      }
      const float above = best + 1e-9f + 5e-3f * best;
      float q = above;
      for (int k = 0; (k = worth.first_above(place, k, places, above, q)) < places; ++k)
        if (accept(place[k])) {
          x = place[k];
          best = q;
          return true;
        }
    } else {
      for (int d = 0; d < directions; ++d)
        if (try_step(direction[d], step))
          return true;
    }
    return false;
  };
  bool moved = false, known = false; // the way up at x
  Vec3d tangent;
  for (double step = 0.2 * length; step > least_step * length && best < goal; step *= 0.4) {
    bool again = true;
    for (int round = 0; again && round < 4 && best < goal; ++round) {
      again = false;
      if (!known) {
        const Vec3d g = worth.ascent(x, 1e-3 * length);
        tangent = {};
        for (int a = 0; a < dimensions; ++a)
          tangent += dot(g, basis[a]) * basis[a];
      }
      const double t = norm(tangent);
      if (t > 0.1 && try_step(tangent / t, step)) {
        again = moved = true;
        known = false;
        continue;
      }
      again = try_directions(step);
      moved |= again;
      known = !again;
    }
  }
  return moved;
}

} // namespace molmesh
