// dense_map.hpp — values on all points of a lattice with any axes, as maps of cryo-EM and electrostatics have them.
#pragma once
#include "base/large_array.hpp"
#include "geom/vec.hpp"
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace molmesh::compose {

/// Point (i,j,k) lies at origin + i·axis[0] + j·axis[1] + k·axis[2].
struct DenseMap {
  Vec3i points;            ///< along each axis, at least 2
  Vec3d origin;            ///< Å
  Vec3d axis[3];           ///< Å, independent
  LargeArray<float> value; ///< i fastest, finite

  int64_t index(int32_t i, int32_t j, int32_t k) const {
    return i + int64_t{points.x} * (j + int64_t{points.y} * k);
  }
  float at(Vec3i p) const { return value[index(p.x, p.y, p.z)]; }
  double volume_of_cell() const { return dot(axis[0], cross(axis[1], axis[2])); } ///< Å³; negative: left-handed
  /// Rows that turn a position relative to the origin into indices.
  void to_indices(Vec3d (&row)[3]) const {
    const double v = volume_of_cell();
    for (int a = 0; a < 3; ++a)
      row[a] = cross(axis[(a + 1) % 3], axis[(a + 2) % 3]) / v;
  }
  /// Cubic convolution along each axis (Keys 1981, a = -1/2): through the values, with continuous first
  /// derivatives. u: indices, within the lattice; values beyond its walls are those at the walls.
  double tricubic(Vec3d u) const;
  /// No value of tricubic() lies farther from the middle of the range of the values it sums than this many half
  /// ranges.
  static constexpr double overshoot = 1.953125;
};

inline double DenseMap::tricubic(Vec3d u) const {
  int32_t at[3][4];
  double w[3][4];
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<int32_t>(std::floor(u[a]));
    const double t = u[a] - i;
    for (int n = 0; n < 4; ++n)
      at[a][n] = std::clamp(i - 1 + n, 0, points[a] - 1);
    w[a][0] = t * (-0.5 + t * (1 - 0.5 * t));
    w[a][1] = 1 + t * t * (-2.5 + 1.5 * t);
    w[a][2] = t * (0.5 + t * (2 - 1.5 * t));
    w[a][3] = t * t * (-0.5 + 0.5 * t);
  }
  double sum = 0;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j) {
      const float* const line = value.data() + index(0, at[1][j], at[2][k]);
      double s = 0;
      for (int i = 0; i < 4; ++i)
        s += w[0][i] * line[at[0][i]];
      sum += w[2][k] * w[1][j] * s;
    }
  return sum;
}

} // namespace molmesh::compose
