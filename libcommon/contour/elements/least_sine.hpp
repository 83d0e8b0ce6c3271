// least_sine.hpp — the least sine of an element's dihedral angles, by which flat elements are avoided. Host and
// device.
#pragma once
#include "contour/elements/shape_simd.hpp"
#include "geom/vec.hpp"
#include <cmath>

namespace molmesh::contour {

MOLMESH_HD inline double lesser(double a, double b) {
  return b < a ? b : a;
}

/// Of the dihedral angles; -1 where the volume is not positive.
MOLMESH_HD inline double least_sine(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const Corners<double> corners{{a.x, b.x, c.x, d.x}, {a.y, b.y, c.y, d.y}, {a.z, b.z, c.z, d.z}};
  Sines<double> sines;
  begin_sines(corners, sines);
  for (double& length : sines.length)
    length = std::sqrt(length);
  double least;
  least_of(sines, least);
  return least;
}

/// least_sine of n elements, many at once on the host. corner(i, k): of element i
template <class Corner>
MOLMESH_HD void least_sines(int n, const Corner& corner, double* least) {
#ifndef __CUDA_ARCH__
  constexpr int few = 2;
  for (int first = 0; n > few && first < n; first += 8) {
    const int last = n - first < 8 ? n - first - 1 : 7;
    EightElements eight;
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 4; ++k)
        eight.set(static_cast<size_t>(i), static_cast<size_t>(k), corner(first + (i < last ? i : last), k));
    double of[8];
    eight_least_sines(eight, of);
    for (int i = 0; i <= last; ++i)
      least[first + i] = of[i];
  }
  if (n > few)
    return;
#endif
  for (int i = 0; i < n; ++i)
    least[i] = least_sine(corner(i, 0), corner(i, 1), corner(i, 2), corner(i, 3));
}

} // namespace molmesh::contour
