// predicates.hpp — computes the exact orientation of four points. Host and device.
#pragma once
#include "geom/expansion.hpp"
#include "geom/vec.hpp"

namespace molmesh {

namespace detail {
/// Coordinate differences, each exact as sum + error.
struct ExactDifference {
  TwoTerms x, y, z;
};
MOLMESH_HD inline ExactDifference exact_difference(Vec3d a, Vec3d b) {
  return {two_sum(a.x, -b.x), two_sum(a.y, -b.y), two_sum(a.z, -b.z)};
}
/// out += f · (a·b - c·d)
MOLMESH_HD inline void add_minor(Expansion<192>& out, TwoTerms f, TwoTerms a, TwoTerms b, TwoTerms c, TwoTerms d) {
  Expansion<16> minor;
  const double av[2] = {a.sum, a.error}, bv[2] = {b.sum, b.error}, cv[2] = {c.sum, c.error},
               dv[2] = {d.sum, d.error};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      minor.add_product(av[i], bv[j]);
      minor.add_product(-cv[i], dv[j]);
    }
  for (int i = 0; i < minor.size; ++i) {
    out.add_product(minor.term[i], f.sum);
    out.add_product(minor.term[i], f.error);
  }
}
MOLMESH_HD_CALL inline int orient3d_exact(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const ExactDifference u = exact_difference(b, a), v = exact_difference(c, a), w = exact_difference(d, a);
  Expansion<192> det; // 3 minors of at most 16 terms, each times two terms, two doubles a product
  add_minor(det, w.x, u.y, v.z, u.z, v.y);
  add_minor(det, w.y, u.z, v.x, u.x, v.z);
  add_minor(det, w.z, u.x, v.y, u.y, v.x);
  return det.sign();
}
} // namespace detail

/// Sign (-1, 0, 1) of dot(cross(b - a, c - a), d - a) in exact arithmetic: 1 for a tetrahedron of positive volume
/// in VTK's order. A filter in double answers unless |determinant| ≤ (7 + 56 ε) ε · permanent, ε = 2^-53 (Shewchuk
/// 1997, bound A of orient3d: the same sum of products of rounded differences); then expansions decide. Exact for
/// finite coordinates up to 2^330 (1e99) that are multiples of 2^-340 (all doubles of magnitude over 1e-86). Needs
/// IEEE double arithmetic: no -ffast-math, no contraction of a·b + c.
MOLMESH_HD inline int orient3d(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const Vec3d u = b - a, v = c - a, w = d - a;
  const double yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z, xy = u.x * v.y, yx = u.y * v.x;
  const double det = (yz - zy) * w.x + (zx - xz) * w.y + (xy - yx) * w.z;
  const double permanent = (std::fabs(yz) + std::fabs(zy)) * std::fabs(w.x) +
                           (std::fabs(zx) + std::fabs(xz)) * std::fabs(w.y) +
                           (std::fabs(xy) + std::fabs(yx)) * std::fabs(w.z);
  constexpr double epsilon = 0x1p-53, relative = (7 + 56 * epsilon) * epsilon;
  constexpr double underflow = 1e-200; // more than products that underflow can lose within the range above
  const double bound = relative * permanent + underflow;
  if (det > bound)
    return 1;
  if (det < -bound)
    return -1;
  return detail::orient3d_exact(a, b, c, d);
}

} // namespace molmesh
