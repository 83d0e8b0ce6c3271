// surface_cell.hpp — a fine cell that the surface crosses, and the mass centre and normal of the surface in it.
#pragma once
#include "base/log.hpp"
#include "geom/vec.hpp"
#include <cstdint>

namespace molmesh::contour {

/// A fine cell that the surface crosses.
struct SurfaceCell {
  uint64_t key;   ///< Morton code of the lower corner, lattice point
  float value[8]; ///< at corner c = x + 2 y + 4 z
};

/// Surface of one fine cell: the mean of its crossings with the cell's edges (the paper's mass centre), in lattice
/// coordinates, and the unit gradient of G, inwards; zero where it vanishes.
struct SurfaceSample {
  Vec3d point, normal;
};

/// Crossing of the surface with the straight line between two neighbouring values, as a share of the way from a to
/// b: log G is interpolated, since G falls exponentially. Kept away from both ends. log_a: of a / isovalue. V:
/// double, or one of the compiler's vectors of them.
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void crossing_shares(const V& a, const V& b, const V& log_a,
                                                                      const V& log_b, double isovalue, V& share) {
  constexpr double end = 0.02; // of an edge between its end and a crossing
  const auto logarithmic = (a > 0) & (b > 0);
  const V fa = logarithmic ? log_a : a - isovalue, fb = logarithmic ? log_b : b - isovalue;
  const V half = V{} + 0.5, least = V{} + end, most = V{} + (1 - end);
  const V s = fa == fb ? half : fa / (fa - fb), not_above = s > most ? most : s;
  share = s < least ? least : not_above;
}
MOLMESH_HD inline double crossing_share(double a, double b, double isovalue) {
  const bool logarithmic = a > 0 && b > 0;
  double share;
  crossing_shares(a, b, logarithmic ? portable_log(a / isovalue) : 0, logarithmic ? portable_log(b / isovalue) : 0,
                  isovalue, share);
  return share;
}

/// Of a cell in each lane. value: [8] at corner c = x + 2 y + 4 z. point: within the cell, in fine spacings;
/// gradient: of G, times 4.
template <class V, class U>
MOLMESH_HD __attribute__((always_inline)) inline void sample_cells(const V* value, double isovalue, V (&point)[3],
                                                                   V (&gradient)[3]) {
  V logarithm[8]; // anything where a value is not positive
  for (int c = 0; c < 8; ++c)
    portable_logs<V, U>(isovalue == 1 ? value[c] : value[c] / isovalue, logarithm[c]); // it mostly is
  V crossings{};
  const V zero{}, one = zero + 1;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = gradient[axis] = zero;
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 8; ++c) {
      const int d = c | 1 << axis;
      if (d == c)
        continue;
      gradient[axis] += value[d] - value[c];
      V share;
      crossing_shares(value[c], value[d], logarithm[c], logarithm[d], isovalue, share);
      const auto crossed = (value[c] > isovalue) != (value[d] > isovalue);
      crossings += crossed ? one : zero;
      for (int a = 0; a < 3; ++a)
        if (a == axis)
          point[a] += crossed ? share : zero;
        else if (c >> a & 1)
          point[a] += crossed ? one : zero;
    }
  for (int a = 0; a < 3; ++a)
    point[a] = point[a] / crossings;
}

} // namespace molmesh::contour
