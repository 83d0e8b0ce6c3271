// walls.hpp — keeps points within the planes that a mesh ends at. Host and device.
#pragma once
#include "geom/vec.hpp"

namespace molmesh::optimize {

/// Planes of flat labels that have all of the mesh on one side; ±1e300 where there is none.
struct Walls {
  Vec3d low{-1e300, -1e300, -1e300}, high{1e300, 1e300, 1e300};
  double rounding = 0; ///< Å: how far points of one wall may lie apart

  /// No nearer to a wall than `apart` (Å), or than it was at `from`.
  MOLMESH_HD bool allow(Vec3d from, Vec3d to, double apart) const {
    bool clear = true;
    for (int a = 0; a < 3; ++a) {
      const double above = from[a] - low[a], below = high[a] - from[a];
      clear = clear && to[a] - low[a] >= (above < apart ? above : apart) &&
              high[a] - to[a] >= (below < apart ? below : apart);
    }
    return clear;
  }
  /// No nearer to a wall than `apart`.
  MOLMESH_HD bool clear(Vec3d at, double apart) const {
    bool far = true;
    for (int a = 0; a < 3; ++a)
      far = far && at[a] - low[a] >= apart && high[a] - at[a] >= apart;
    return far;
  }
  /// The triangle lies in one.
  MOLMESH_HD bool hold(Vec3d p, Vec3d q, Vec3d r) const {
    bool in = false;
    for (int a = 0; a < 3; ++a) {
      const double at_low = low[a] + rounding, at_high = high[a] - rounding;
      in = in || (p[a] <= at_low && q[a] <= at_low && r[a] <= at_low) ||
           (p[a] >= at_high && q[a] >= at_high && r[a] >= at_high);
    }
    return in;
  }
};

/// How near to a wall a point of a curved surface may come, in spacings.
inline constexpr double apart_from_walls = 0.01;

} // namespace molmesh::optimize
