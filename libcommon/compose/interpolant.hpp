// interpolant.hpp — a density between its grid points, by moving least squares (Levin 1998).
#pragma once
#include "grid/block_grid.hpp"

namespace molmesh::compose {

/// ln(G / isovalue) near the band of a grid: the value of a quadratic polynomial that fits the known values round
/// the point, near ones and those next to the surface most. It nearly meets a single atom, whose
/// logarithm is quadratic.
class Interpolant {
public:
  Interpolant(const BlockGrid& grid, int threads);

  struct Value {
    double f = 0;   ///< ln(G / isovalue)
    Vec3d gradient; ///< per spacing
  };
  /// u: in spacings from index (0,0,0). False where no active point is within the 4³ points round u, but for fits
  /// that cannot be made.
  bool fit(Vec3d u, Value& value) const;
  /// By the grid point next to u.
  bool inside(Vec3i p) const { return value_at(grid_, index_, p) > static_cast<float>(grid_.info.isovalue); }
  /// Are all corners of the cell active, as those of band cells are?
  bool whole(Vec3i cell) const;
  /// The side of all corners of the cell at `cell`: 1 inside, -1 outside, 0 where they differ.
  int side(Vec3i cell) const;

private:
  const BlockGrid& grid_;
  BlockIndex index_;
  LargeArray<float> log_; ///< [512 n], NaN where not active
};

} // namespace molmesh::compose
