// cell_levels.hpp — sorts boxes of any size into grids of cells, each into the grid whose cells fit it, so that a
// few cells hold it. Level l has cells of 4^l times the size.
#pragma once
#include "geom/vec.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace molmesh {

inline int64_t cell_of(double place) {
  constexpr double far = 4e18; // where differences still fit
  return static_cast<int64_t>(std::clamp(std::floor(place), -far, far));
}

struct CellRange {
  std::array<int64_t, 3> low, high;

  /// Axes, a bit each, on which the cell is the range's first. A cell that is first on each axis in one of two
  /// ranges is the first that they share.
  uint8_t begins(int64_t i, int64_t j, int64_t k) const {
    return uint8_t((i == low[0]) | (j == low[1]) << 1 | (k == low[2]) << 2);
  }

  bool operator==(const CellRange&) const = default;
  double count() const {
    double cells = 1;
    for (size_t a = 0; a < 3; ++a)
      cells *= double(high[a] - low[a]) + 1;
    return cells;
  }
  template <class F>
  void for_each(F&& f) const {
    for (int64_t i = low[0]; i <= high[0]; ++i)
      for (int64_t j = low[1]; j <= high[1]; ++j)
        for (int64_t k = low[2]; k <= high[2]; ++k)
          f(i, j, k);
  }
};

inline double cell_size(double cell, int level) {
  return level == 0 ? cell : std::ldexp(cell, 2 * level); // nearly always
}

template <class T>
CellRange cell_range(Vec3<T> low, Vec3<T> high, double size) {
  CellRange r;
  for (int a = 0; a < 3; ++a) {
    r.low[a] = cell_of(double(low[a]) / size);
    r.high[a] = cell_of(double(high[a]) / size);
  }
  return r;
}

/// Of a box: it meets three cells of that level on an axis, at most.
template <class T>
int cell_level(Vec3<T> low, Vec3<T> high, double cell) {
  const Vec3<T> size = high - low;
  const double longest = double(std::max({size.x, size.y, size.z}));
  int level = 0;
  while (level < 62 && longest > 2 * cell_size(cell, level))
    ++level;
  return level;
}

inline uint64_t cell_key(int64_t i, int64_t j, int64_t k, int level) {
  return uint64_t(i) * 0x9E3779B97F4A7C15u + uint64_t(j) * 0xC2B2AE3D27D4EB4Fu + uint64_t(k) * 0x165667B19E3779F9u +
         uint64_t(level) * 0xD6E8FEB86659FD93u;
}

/// f(level) for each bit of `levels`, ascending.
template <class F>
void for_levels(uint64_t levels, F&& f) {
  for (int level = 0; levels >> level != 0; ++level)
    if (levels >> level & 1)
      f(level);
}

} // namespace molmesh
