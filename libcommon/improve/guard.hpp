// guard.hpp — how far a surface triangle may be from the target. Host and device.
#pragma once
#include "geom/vec.hpp"
#include <cmath>

namespace molmesh::improve {

/// How far a surface triangle may be from the target.
struct Guard {
  double angle = 32;      ///< degrees between its normal and the target's at its centroid
  double distance = 0.12; ///< of its centroid, in spacings
  double reach = 0.5;     ///< of a projection, in edge lengths: further, and pinches drop two points on one place
  double lift = 0;        ///< how far one operation may take a surface point off the target, in spacings
  bool operator==(const Guard&) const = default;
  HD double tilt() const { return 1 - std::cos(angle * 3.14159265358979323846 / 180); } ///< as misfit() wants it
};

/// Of a triangle that runs as the target's normal does: at most 1 when the guard is kept. A triangle where the
/// target is not known is bad, but not worse than another such one. most_tilt: guard.tilt(), for many triangles.
/// Surface: probe() and spacing() as in Target.
template <class Surface>
HD double misfit(const Surface& target, const Guard& guard, double most_tilt, Vec3d a, Vec3d b, Vec3d c) {
  double distance;
  Vec3d normal;
  if (!target.probe((a + b + c) / 3., distance, normal))
    return 10;
  const Vec3d n = cross(b - a, c - a);
  const double length = norm(n), cosine = dot(n, normal) / (length > 1e-300 ? length : 1e-300);
  const double far = std::abs(distance) / (guard.distance * target.spacing()), tilt = (1 - cosine) / most_tilt;
  return far < tilt ? tilt : far;
}
template <class Surface>
HD double misfit(const Surface& target, const Guard& guard, Vec3d a, Vec3d b, Vec3d c) {
  return misfit(target, guard, guard.tilt(), a, b, c);
}

/// What an element below the goal lacks: goal / q - 1 when the worst matter most, (1 - q / goal)² when all do;
/// nothing where only the worst element counts.
HD inline float lack(float q, float goal, bool worst_first, const Guard& guard) {
  return q >= goal || guard.lift > 0 ? 0
         : worst_first               ? goal / (q > 1e-4f ? q : 1e-4f) - 1
                                     : (1 - q / goal) * (1 - q / goal);
}

} // namespace molmesh::improve
