// quality.hpp — how good a tetrahedron is: its worst dihedral angle, or that it is a needle.
#pragma once
#include "geom/vec.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::improve {

/// Weight of an obtuse angle's sine: 25° counts like 140°, 28° like 134°.
inline constexpr double obtuse_weight = 0.66;

/// Joe and Liu's Q (equation 8 of the paper) is 20.78 · 6V / (Σ edge²)^1.5; squared and times this it counts like
/// angle_quality: 0.30 like 25°.
inline constexpr double shape_weight = 432 * 0.17861 / 0.09;

/// Quality of the dihedral angle θ: sin²θ, obtuse ones times obtuse_weight². Monotone on both sides of 90°.
inline double angle_quality(double degrees) {
  const double s = std::sin(degrees * 3.14159265358979323846 / 180) * (degrees > 90 ? obtuse_weight : 1);
  return s * s;
}

/// Smallest angle_quality of the six dihedral angles, or shape_weight Q² when that is less (angles alone leave
/// needles, and needles leave no room to repair what is around them); -1 when the volume is not positive in
/// floating point. With face normals n of length twice the area and D six times the volume, sin²θ at edge e between
/// faces i and j is D² |e|² / (|n_i|² |n_j|²), accurate for flat elements too.
HD inline float tet_quality(Vec3d p0, Vec3d p1, Vec3d p2, Vec3d p3) {
  const Vec3d a = p1 - p0, b = p2 - p0, c = p3 - p0;
  const Vec3d n1 = cross(c, b), n2 = cross(a, c), n3 = cross(b, a);
  const double det = -dot(a, n1);
  if (!(det > 0))
    return -1;
  const Vec3d n0 = -(n1 + n2 + n3);
  const double w = obtuse_weight * obtuse_weight;
  const double r0 = 1 / norm2(n0), r1 = 1 / norm2(n1), r2 = 1 / norm2(n2), r3 = 1 / norm2(n3);
  // Outward normals of an obtuse angle have a positive product.
  const auto term = [w](Vec3d ni, Vec3d nj, double rij, double edge2) {
    return edge2 * rij * (dot(ni, nj) > 0 ? w : 1.0);
  };
  const auto lesser = [](double x, double y) { return y < x ? y : x; }; // std::min is a host function to nvcc
  double s = term(n0, n1, r0 * r1, norm2(c - b));
  s = lesser(s, term(n0, n2, r0 * r2, norm2(c - a)));
  s = lesser(s, term(n0, n3, r0 * r3, norm2(b - a)));
  s = lesser(s, term(n1, n2, r1 * r2, norm2(c)));
  s = lesser(s, term(n1, n3, r1 * r3, norm2(b)));
  s = lesser(s, term(n2, n3, r2 * r3, norm2(a)));
  const double sum = norm2(a) + norm2(b) + norm2(c) + norm2(b - a) + norm2(c - b) + norm2(c - a);
  s = lesser(s, shape_weight / (sum * sum * sum));
  return static_cast<float>(s * det * det);
}

} // namespace molmesh::improve
