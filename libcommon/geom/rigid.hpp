// rigid.hpp — rigid motions: a rotation, then a translation.
#pragma once
#include "geom/vec.hpp"
#include <cmath>
#include <vector>

namespace molmesh {

/// p ↦ R·p + t; row[i] is row i of R, t in Å.
struct Rigid {
  Vec3d row[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3d t;

  /// Of the identity: p itself, to the last bit.
  Vec3d operator()(Vec3d p) const {
    return is_identity() ? p : Vec3d{dot(row[0], p), dot(row[1], p), dot(row[2], p)} + t;
  }
  /// R·v.
  Vec3d turned(Vec3d v) const { return is_identity() ? v : Vec3d{dot(row[0], v), dot(row[1], v), dot(row[2], v)}; }
  bool turns_nothing() const {
    return row[0] == Vec3d{1, 0, 0} && row[1] == Vec3d{0, 1, 0} && row[2] == Vec3d{0, 0, 1};
  }
  bool is_identity() const { return turns_nothing() && t == Vec3d{}; }
};

/// First b, then a.
inline Rigid operator*(const Rigid& a, const Rigid& b) {
  Rigid c;
  const Vec3d column[3] = {{b.row[0].x, b.row[1].x, b.row[2].x},
                           {b.row[0].y, b.row[1].y, b.row[2].y},
                           {b.row[0].z, b.row[1].z, b.row[2].z}};
  for (int i = 0; i < 3; ++i)
    c.row[i] = {dot(a.row[i], column[0]), dot(a.row[i], column[1]), dot(a.row[i], column[2])};
  c.t = a.turned(b.t) + a.t;
  return c;
}

/// Is R, to `within` in each entry of Rᵀ·R, a rotation that mirrors nothing, and all finite?
inline bool is_rotation(const Rigid& m, double within) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double entry = m.row[0][i] * m.row[0][j] + m.row[1][i] * m.row[1][j] + m.row[2][i] * m.row[2][j];
      if (!(std::abs(entry - (i == j ? 1 : 0)) <= within))
        return false;
    }
  return dot(m.row[0], cross(m.row[1], m.row[2])) > 0 && std::isfinite(m.t.x + m.t.y + m.t.z);
}

/// By `degrees` about the axis through `point` along `axis`, which is not 0; counterclockwise seen from the axis'
/// end. Multiples of 90° are exact about the axes of the coordinates.
inline Rigid rotation(Vec3d axis, double degrees, Vec3d point) {
  constexpr double pi = 3.141592653589793238462643383279502884;
  const double turn = std::remainder(degrees, 360.0);
  double c = std::cos(turn * pi / 180), s = std::sin(turn * pi / 180);
  if (std::remainder(turn, 90.0) == 0) {
    c = turn == 0 ? 1 : std::abs(turn) == 180 ? -1 : 0;
    s = turn == 90 ? 1 : turn == -90 ? -1 : 0;
  }
  const Vec3d u = axis / norm(axis);
  Rigid m;
  m.row[0] = {c + u.x * u.x * (1 - c), u.x * u.y * (1 - c) - u.z * s, u.x * u.z * (1 - c) + u.y * s};
  m.row[1] = {u.y * u.x * (1 - c) + u.z * s, c + u.y * u.y * (1 - c), u.y * u.z * (1 - c) - u.x * s};
  m.row[2] = {u.z * u.x * (1 - c) - u.y * s, u.z * u.y * (1 - c) + u.x * s, c + u.z * u.z * (1 - c)};
  m.t = point - m.turned(point);
  return m;
}

inline Rigid translation(Vec3d t) {
  Rigid m;
  m.t = t;
  return m;
}

/// Of its three rows, 9 numbers, or 12 of which every fourth is the shift along that axis.
inline Rigid rigid_of_rows(const std::vector<double>& v) {
  Rigid m;
  const size_t width = v.size() / 3;
  for (size_t i = 0; i < 3; ++i) {
    m.row[i] = {v[width * i], v[width * i + 1], v[width * i + 2]};
    m.t[static_cast<int>(i)] = width == 4 ? v[4 * i + 3] : 0;
  }
  return m;
}

} // namespace molmesh
