// guard.hpp — how far a surface triangle may be from the target. Host and device.
#pragma once
#include "base/lanes.hpp"
#include "geom/vec.hpp"
#include <cmath>

namespace molmesh {

/// How far a surface triangle may be from the target.
struct Guard {
  static constexpr double anywhere = 1e300;
  double angle = 32;      ///< degrees between its normal and the target's at its centroid
  double distance = 0.12; ///< of its centroid, in spacings
  /// Longest allowed projection, in edge lengths; longer ones merge two points where the surface is pinched.
  double reach = 0.5;
  double lift = 0;         ///< how far one operation may take a surface point off the target, in spacings
  double leave = anywhere; ///< and how far all of them; of targets whose distances are exact
  bool operator==(const Guard&) const = default;
  /// Wider guards let triangles bend further, and those still count as bent.
  static constexpr double widest_unbent = 44;
  double tilt() const { return 1 - std::cos(angle * 3.14159265358979323846 / 180); } ///< as misfit() wants it
};

/// Of a triangle where the target is not known: bad, but not worse than another such one.
inline constexpr double unknown_misfit = 10;

/// misfit() of a triangle with a normal n of that length, from the target's distance (Å) and normal at its
/// centroid. far: Å, of one that just keeps the guard.
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void misfit_at(const V (&n)[3], const V& length, const V& distance,
                                                                const V (&normal)[3], double far, double most_tilt,
                                                                V& misfit) {
  const V least = V{} + 1e-300;
  const V cosine = (n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2]) / (length > least ? length : least);
  const V off = (distance < 0 ? -distance : distance) / far, tilt = (1 - cosine) / most_tilt;
  misfit = off < tilt ? tilt : off;
}

/// Of a triangle that runs as the target's normal does: at most 1 when the guard is kept. most_tilt: guard.tilt(),
/// for many triangles. Surface: probe() and spacing() as in Target.
template <class Surface>
MOLMESH_HD double misfit(const Surface& target, const Guard& guard, double most_tilt, Vec3d a, Vec3d b, Vec3d c) {
  double distance;
  Vec3d normal;
  if (!target.probe((a + b + c) / 3., distance, normal))
    return unknown_misfit;
  const Vec3d n = cross(b - a, c - a);
  const double area[3] = {n.x, n.y, n.z}, along[3] = {normal.x, normal.y, normal.z};
  double misfit;
  misfit_at(area, norm(n), distance, along, guard.distance * target.spacing(), most_tilt, misfit);
  return misfit;
}

} // namespace molmesh
