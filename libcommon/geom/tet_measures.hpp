// tet_measures.hpp — size and shape of one tetrahedron or triangle. Host and device; lengths in Å.
#pragma once
#include "geom/vec.hpp"

namespace molmesh {

/// Six times the signed volume (Å³); positive in VTK's order.
MOLMESH_HD inline double six_volume(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  return dot(cross(b - a, c - a), d - a);
}
MOLMESH_HD inline double tet_volume(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  return six_volume(a, b, c, d) / 6;
}
/// Twice the area along the normal; towards the viewer who sees a, b, c counter-clockwise.
MOLMESH_HD inline Vec3d tri_normal(Vec3d a, Vec3d b, Vec3d c) {
  return cross(b - a, c - a);
}
MOLMESH_HD inline double tri_area(Vec3d a, Vec3d b, Vec3d c) {
  return norm(tri_normal(a, b, c)) / 2;
}

/// Ends of edge e of a tetrahedron: 01 02 03 12 13 23. The edge opposite to e is 5 - e.
MOLMESH_HD constexpr int tet_edge(int e, int end) {
  return end == 0 ? (e < 3 ? 0 : e < 5 ? 1 : 2) : (e == 0 ? 1 : e == 1 || e == 3 ? 2 : 3);
}
/// Corner i of the face opposite to corner f, counter-clockwise seen from outside.
MOLMESH_HD constexpr int tet_face(int f, int i) {
  return (f == 0 ? 0x321 : f == 1 ? 0x230 : f == 2 ? 0x310 : 0x120) >> (4 * i) & 3;
}

/// Cosines and sines of the dihedral angles, in the order of tet_edge. Sines carry the sign of the volume; a face
/// of area zero gives NaN.
struct DihedralTrig {
  double cosine[6], sine[6];
};
MOLMESH_HD inline DihedralTrig dihedral_trig(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const Vec3d ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
  const Vec3d n[4] = {cross(bc, bd), cross(ad, ac), cross(ab, ad), cross(ac, ab)}; // outward, twice the face areas
  const double six_v = -dot(n[3], ad);
  double inverse[4];
  for (int f = 0; f < 4; ++f)
    inverse[f] = 1 / norm(n[f]);
  const double length[6] = {norm(ab), norm(ac), norm(ad), norm(bc), norm(bd), norm(cd)};
  DihedralTrig t;
  for (int e = 0; e < 6; ++e) {
    const int f = tet_edge(5 - e, 0), g = tet_edge(5 - e, 1); // the two faces that share e
    const double scale = inverse[f] * inverse[g];
    t.cosine[e] = -dot(n[f], n[g]) * scale;
    t.sine[e] = six_v * length[e] * scale; // V = 2/3 A A' sin / length
  }
  return t;
}

/// Dihedral angles in degrees, in the order of tet_edge: 0 to 180, negative where the volume is (not -0).
struct Dihedrals {
  double degree[6];
};
MOLMESH_HD inline Dihedrals dihedrals(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const DihedralTrig t = dihedral_trig(a, b, c, d);
  Dihedrals angle;
  for (int e = 0; e < 6; ++e)
    angle.degree[e] = std::atan2(t.sine[e] + 0.0, t.cosine[e]) * (180 / 3.14159265358979323846);
  return angle;
}

/// Sum of the squared edge lengths (Å²).
MOLMESH_HD inline double edge_sum2(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  return norm2(b - a) + norm2(c - a) + norm2(d - a) + norm2(c - b) + norm2(d - b) + norm2(d - c);
}
/// Equation 8 of the paper, Q = 8·3^(5/2) V / (Σ e²)^(3/2): 1 for the regular tetrahedron, at most 1, signed as V.
MOLMESH_HD inline double joe_liu_q(double six_v, double sum2) {
  return 20.784609690826528 * six_v / (sum2 * std::sqrt(sum2)); // 8·3^(5/2) / 6
}
/// Joe and Liu's η = 12 (3V)^(2/3) / Σ e², the common form. Equation 8 is η^(3/2), since 12^(3/2)·3 = 8·3^(5/2).
MOLMESH_HD inline double joe_liu_eta(double q) {
  return q < 0 ? -std::cbrt(q * q) : std::cbrt(q * q);
}
/// Longest over shortest edge.
MOLMESH_HD inline double edge_ratio(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const double e[6] = {norm2(b - a), norm2(c - a), norm2(d - a), norm2(c - b), norm2(d - b), norm2(d - c)};
  double low = e[0], high = e[0];
  for (int i = 1; i < 6; ++i) {
    low = e[i] < low ? e[i] : low;
    high = e[i] > high ? e[i] : high;
  }
  return std::sqrt(high / low);
}

} // namespace molmesh
