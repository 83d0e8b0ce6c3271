// trilinear.hpp — a density between grid points, as a function that other mesh generators can ask.
#pragma once
#include "grid/block_grid.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::reference {

/// log G, trilinear; the band's constants beyond it.
class Trilinear {
public:
  explicit Trilinear(const BlockGrid& grid) : grid_(grid), index_(grid) {}
  double operator()(Vec3d x) const {
    const Vec3d r = (x - grid_.frame.origin) / grid_.frame.spacing;
    const Vec3i low{int32_t(std::floor(r.x)), int32_t(std::floor(r.y)), int32_t(std::floor(r.z))};
    const Vec3d t = r - to_double(low);
    double sum = 0;
    for (int c = 0; c < 8; ++c) {
      const int i = c & 1, j = c >> 1 & 1, k = c >> 2;
      const double g = value_at(grid_, index_, low + Vec3i{i, j, k});
      sum += (i ? t.x : 1 - t.x) * (j ? t.y : 1 - t.y) * (k ? t.z : 1 - t.z) * std::log(std::max(g, 1e-6));
    }
    return sum - std::log(grid_.info.isovalue);
  }

  /// Of a sphere round the grid.
  Vec3d center() const { return grid_.frame.position(grid_.frame.lower) + 0.5 * extent(); }
  double radius() const { return norm(extent()) / 2; }

private:
  Vec3d extent() const { return grid_.frame.spacing * to_double(grid_.frame.points - Vec3i{1, 1, 1}); }

  const BlockGrid& grid_;
  BlockIndex index_;
};

} // namespace molmesh::reference
