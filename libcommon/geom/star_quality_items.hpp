// star_quality_items.hpp — the quality of an element at a moving vertex, in single precision. Host and device.
#pragma once
#include "geom/tet_quality.hpp"

namespace molmesh {

/// An element (vertex, a, b, c) of a vertex star, of positive volume: what does not change as the vertex moves. V:
/// float, or one of the compiler's vectors with an element in each lane.
template <class V>
struct StarElement {
  V ax, ay, az, bx, by, bz, cx, cy, cz;
  V nx, ny, nz, r; ///< normal of a b c, twice its area long, and 1 / |n|²
  V ab, bc, ca;    ///< squared edges
};

/// From its corners.
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void complete(StarElement<V>& s) {
  const V ux = s.bx - s.ax, uy = s.by - s.ay, uz = s.bz - s.az, vx = s.cx - s.ax, vy = s.cy - s.ay,
          vz = s.cz - s.az;
  const V wx = s.cx - s.bx, wy = s.cy - s.by, wz = s.cz - s.bz;
  s.nx = uy * vz - uz * vy;
  s.ny = uz * vx - ux * vz;
  s.nz = ux * vy - uy * vx;
  s.r = 1 / (s.nx * s.nx + s.ny * s.ny + s.nz * s.nz);
  s.ab = ux * ux + uy * uy + uz * uz;
  s.bc = wx * wx + wy * wy + wz * wz;
  s.ca = vx * vx + vy * vy + vz * vz;
}

MOLMESH_HD inline StarElement<float> make_star_element(Vec3f a, Vec3f b, Vec3f c) {
  StarElement<float> s{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, 0, 0, 0, 0, 0, 0, 0};
  complete(s);
  return s;
}

/// Corners of an element with the vertex `moving` in front, the others in an even permutation.
MOLMESH_HD constexpr int star_corner(int moving, int i) {
  return (moving == 0 ? 0x3210 : moving == 1 ? 0x2301 : moving == 2 ? 0x1032 : 0x0123) >> (4 * i) & 3;
}

/// 1 / x and a / x, as star_element_quality asks for them.
struct Division {
  template <class V>
  MOLMESH_HD __attribute__((always_inline)) inline void invert(const V& x, V& out) const {
    out = 1 / x;
  }
  template <class V>
  MOLMESH_HD __attribute__((always_inline)) inline void divide(float a, const V& x, V& out) const {
    out = a / x;
  }
};

/// With the vertex at x, y, z; Q weighted as tet_quality has it. V: the wider of S and X, of which either may be
/// float: elements in the lanes, or places. A lane's bits are the scalar's. Vectors come and go by reference: what
/// they look like as arguments depends on the processor.
template <class S, class X, class V, class By = const Division>
MOLMESH_HD __attribute__((always_inline)) inline void star_element_quality(const StarElement<S>& s, const X& x,
                                                                           const X& y, const X& z, V& q,
                                                                           float q_weight, By&& division = {}) {
  const V ax = s.ax - x, ay = s.ay - y, az = s.az - z;
  const V bx = s.bx - x, by = s.by - y, bz = s.bz - z;
  const V cx = s.cx - x, cy = s.cy - y, cz = s.cz - z;
  // Outward normals of the faces opposite a, b, c; n is that of the one opposite the vertex.
  const V ux = cy * bz - cz * by, uy = cz * bx - cx * bz, uz = cx * by - cy * bx;
  const V vx = ay * cz - az * cy, vy = az * cx - ax * cz, vz = ax * cy - ay * cx;
  const V tx = by * az - bz * ay, ty = bz * ax - bx * az, tz = bx * ay - by * ax;
  const V det = -(ax * ux + ay * uy + az * uz);
  V ru, rv, rt, shape;
  division.invert(ux * ux + uy * uy + uz * uz, ru);
  division.invert(vx * vx + vy * vy + vz * vz, rv);
  division.invert(tx * tx + ty * ty + tz * tz, rt);
  constexpr float obtuse = static_cast<float>(obtuse_weight * obtuse_weight);
  const V one = V{} + 1, w = V{} + obtuse;
  const V s0 = s.bc * s.r * ru * (s.nx * ux + s.ny * uy + s.nz * uz > 0 ? w : one);
  const V s1 = s.ca * s.r * rv * (s.nx * vx + s.ny * vy + s.nz * vz > 0 ? w : one);
  const V s2 = s.ab * s.r * rt * (s.nx * tx + s.ny * ty + s.nz * tz > 0 ? w : one);
  const V aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
  const V sum = aa + bb + cc + s.ab + s.bc + s.ca;
  division.divide(q_weight, sum * sum * sum, shape);
  const V s3 = cc * ru * rv * (ux * vx + uy * vy + uz * vz > 0 ? w : one);
  const V s4 = bb * ru * rt * (ux * tx + uy * ty + uz * tz > 0 ? w : one);
  const V s5 = aa * rv * rt * (vx * tx + vy * ty + vz * tz > 0 ? w : one);
  const V s01 = s0 < s1 ? s0 : s1, s23 = s2 < s3 ? s2 : s3, s45 = s4 < s5 ? s4 : s5;
  const V s03 = s01 < s23 ? s01 : s23, s6 = s45 < shape ? s45 : shape, least = s03 < s6 ? s03 : s6;
  q = det > 0 ? least * det * det : V{} - 1;
}

} // namespace molmesh
