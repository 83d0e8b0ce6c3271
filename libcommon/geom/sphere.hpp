// sphere.hpp — a sphere, and places on it. Host and device.
#pragma once
#include "geom/vec.hpp"

namespace molmesh {

/// In Å.
struct Sphere {
  Vec3d center;
  double radius = 0;

  /// Distance from the sphere, positive outside.
  MOLMESH_HD double height(Vec3d x) const { return norm(x - center) - radius; }
  /// The place on the sphere that is nearest to x, which is not the center.
  MOLMESH_HD Vec3d nearest(Vec3d x) const {
    const Vec3d d = x - center;
    return center + (radius / norm(d)) * d;
  }
  /// How far nearest() may be from the sphere by rounding, with room to spare.
  MOLMESH_HD double rounding() const { return 1e-14 * (norm(center) + radius); }
};

} // namespace molmesh
