// element_shape.hpp — how flat an element is: what is chosen between ways to make elements. Host and device.
#pragma once
#include "geom/tet_measures.hpp"

namespace molmesh::contour::detail {

HD inline double lesser(double a, double b) {
  return b < a ? b : a;
}

/// Of the dihedral angles; -1 where the volume is not positive.
HD inline double least_sine(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const DihedralTrig t = dihedral_trig(a, b, c, d);
  double least = t.sine[0];
  for (int e = 1; e < 6; ++e)
    least = lesser(least, t.sine[e]);
  return six_volume(a, b, c, d) > 0 ? least : -1;
}

} // namespace molmesh::contour::detail
