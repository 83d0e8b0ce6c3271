// tet_quality.hpp — the quality of a tetrahedron: its worst dihedral angle or, for needles, the measure of Joe and
// Liu.
#pragma once
#include "geom/vec.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh {

/// Weight of an obtuse angle's sine: 25° counts like 140°, 28° like 134°.
inline constexpr double obtuse_weight = 0.66;

/// Joe and Liu's Q (equation 8 of the paper) is 20.78 · 6V / (Σ edge²)^1.5; squared and times a weight it counts
/// like angle_quality. The weight with which `q` counts like `angle`, of angle_quality:
constexpr double shape_weight_of(double q, double angle) {
  return 432 * angle / (q * q);
}
/// 0.30 like 25°.
inline constexpr double shape_weight = shape_weight_of(0.3, 0.17861);

/// Quality of the dihedral angle θ: sin²θ, obtuse ones times obtuse_weight². Monotone on both sides of 90°.
inline double angle_quality(double degrees) {
  const double s = std::sin(degrees * 3.14159265358979323846 / 180) * (degrees > 90 ? obtuse_weight : 1);
  return s * s;
}

/// V: double, or one of the compiler's vectors with an element in each lane.
template <class V>
struct Corners {
  V x[4], y[4], z[4];
};

/// As tet_quality. By reference: what vectors look like as arguments depends on the processor.
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void corners_quality(const Corners<V>& p, V& q, double shape) {
  const V ax = p.x[1] - p.x[0], ay = p.y[1] - p.y[0], az = p.z[1] - p.z[0];
  const V bx = p.x[2] - p.x[0], by = p.y[2] - p.y[0], bz = p.z[2] - p.z[0];
  const V cx = p.x[3] - p.x[0], cy = p.y[3] - p.y[0], cz = p.z[3] - p.z[0];
  const V x1 = cy * bz - cz * by, y1 = cz * bx - cx * bz, z1 = cx * by - cy * bx;
  const V x2 = ay * cz - az * cy, y2 = az * cx - ax * cz, z2 = ax * cy - ay * cx;
  const V x3 = by * az - bz * ay, y3 = bz * ax - bx * az, z3 = bx * ay - by * ax;
  const V x0 = -(x1 + x2 + x3), y0 = -(y1 + y2 + y3), z0 = -(z1 + z2 + z3);
  const V det = -(ax * x1 + ay * y1 + az * z1);
  const V one = V{} + 1, w = V{} + obtuse_weight * obtuse_weight;
  const V r0 = 1 / (x0 * x0 + y0 * y0 + z0 * z0), r1 = 1 / (x1 * x1 + y1 * y1 + z1 * z1);
  const V r2 = 1 / (x2 * x2 + y2 * y2 + z2 * z2), r3 = 1 / (x3 * x3 + y3 * y3 + z3 * z3);
  const V ux = bx - ax, uy = by - ay, uz = bz - az, vx = cx - bx, vy = cy - by, vz = cz - bz;
  const V tx = cx - ax, ty = cy - ay, tz = cz - az;
  const V aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
  const V uu = ux * ux + uy * uy + uz * uz, vv = vx * vx + vy * vy + vz * vz, tt = tx * tx + ty * ty + tz * tz;
  // Outward normals of an obtuse angle have a positive product.
  const V s0 = vv * (r0 * r1) * (x0 * x1 + y0 * y1 + z0 * z1 > 0 ? w : one);
  const V s1 = tt * (r0 * r2) * (x0 * x2 + y0 * y2 + z0 * z2 > 0 ? w : one);
  const V s2 = uu * (r0 * r3) * (x0 * x3 + y0 * y3 + z0 * z3 > 0 ? w : one);
  const V s3 = cc * (r1 * r2) * (x1 * x2 + y1 * y2 + z1 * z2 > 0 ? w : one);
  const V s4 = bb * (r1 * r3) * (x1 * x3 + y1 * y3 + z1 * z3 > 0 ? w : one);
  const V s5 = aa * (r2 * r3) * (x2 * x3 + y2 * y3 + z2 * z3 > 0 ? w : one);
  const V sum = aa + bb + cc + uu + vv + tt, s6 = shape / (sum * sum * sum);
  const V s01 = s0 < s1 ? s0 : s1, s23 = s2 < s3 ? s2 : s3, s45 = s4 < s5 ? s4 : s5;
  const V s03 = s01 < s23 ? s01 : s23, s46 = s45 < s6 ? s45 : s6, least = s03 < s46 ? s03 : s46;
  q = det > 0 ? least * det * det : V{} - 1;
}

/// Smallest angle_quality of the six dihedral angles, or Q² weighted by `shape` when that is less (angles alone
/// leave needles, and needles leave no room to repair what is around them); -1 when the volume is not positive in
/// floating point. With face normals n of length twice the area and D six times the volume, sin²θ at edge e between
/// faces i and j is D² |e|² / (|n_i|² |n_j|²), accurate for flat elements too.
MOLMESH_HD inline float tet_quality(Vec3d p0, Vec3d p1, Vec3d p2, Vec3d p3, double shape = shape_weight) {
  const Corners<double> corners{{p0.x, p1.x, p2.x, p3.x}, {p0.y, p1.y, p2.y, p3.y}, {p0.z, p1.z, p2.z, p3.z}};
  double q;
  corners_quality(corners, q, shape);
  return static_cast<float>(q);
}

/// An element of better quality is positive by the exact predicate too: D ≥ √(q / shape_weight) (Σ edge²)^1.5, that
/// is 0.17 √q |a||b||c| and more for edges a, b, c at a corner, and D is off by less than 1e-14 |a||b||c|.
inline constexpr float surely_positive = 1e-6f;

} // namespace molmesh
