// acceptance.hpp — what an operation aims at and what it may not spoil.
#pragma once
#include "geom/pattern_search.hpp"
#include "isosurface/guard.hpp"
#include <algorithm>

namespace molmesh::optimize {

/// How badly triangles fit the target.
struct Fit {
  double worst = 1;  ///< misfit, at least 1
  double excess = 0; ///< sum of what misfits exceed 1 by, and of what a vertex lies off the target
  void add(double misfit) {
    worst = misfit > worst ? misfit : worst;
    excess += misfit > 1 ? misfit - 1 : 0;
  }
  float worth() const { return static_cast<float>(1 / (1 + excess)); } ///< 1: nothing to repair
};

/// Deficit of an element below the goal: goal / q - 1 when the worst matter most, (1 - q / goal)² when all do;
/// nothing where only the worst element counts, and from the goal on. Host and device.
MOLMESH_HD inline float deficit(float q, float goal, bool worst_first, const Guard& guard) {
  return q >= goal || guard.lift > 0 ? 0
         : worst_first               ? goal / (q > 1e-4f ? q : 1e-4f) - 1
                                     : (1 - q / goal) * (1 - q / goal);
}

enum class Aim : uint8_t {
  quality, ///< the worst element concerned rises, and the deficit of all does not
  fit,     ///< the surface triangles concerned fit better, and no element falls under the goal
  size,    ///< fewer elements: none falls under the goal, and no triangle beyond the guard
};

/// Decides about every exchange. Set once for a trial or a sweep, and constant while operations use it.
struct Acceptance {
  Acceptance() : Acceptance(Guard{}) {}
  explicit Acceptance(const Guard& g) : guard(g), most_tilt(g.tilt()) {}

  Guard guard;
  double most_tilt; ///< the guard's
  Aim aim = Aim::quality;
  float goal = 1;                  ///< elements of less quality count in the deficit
  bool worst_first = true;         ///< deficit()
  bool may_bend = false;           ///< the surface may bend beyond the guard
  bool thorough = true;            ///< improve_element() tries edges that seldom help, too
  bool off_target = false;         ///< surface vertices move anywhere near enough to the target, not on it alone
  double least_step = finest_step; ///< pattern_search()
  /// Contractions of tiny edges may lower the worst element to this share where the deficit falls by a tenth.
  float tiny_share = 1;

  bool fits_surface() const { return aim == Aim::fit; }
  bool may_lower() const { return aim != Aim::quality; } ///< elements, down to the goal
  /// What new elements must be better than.
  float demand(float before) const {
    return may_lower() ? 0.999999f * std::min(before, goal) : before + 1e-9f + 0.01f * before;
  }
  bool fits(const Fit& now, const Fit& before) const {
    return may_bend || (fits_surface() ? now.excess < 0.98 * before.excess : now.worst <= before.worst);
  }
  float deficit_of(float q) const { return deficit(q, goal, worst_first, guard); }
};

} // namespace molmesh::optimize
