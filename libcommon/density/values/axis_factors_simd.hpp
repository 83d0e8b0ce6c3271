// axis_factors_simd.hpp — makes the factors of a block's atoms along its axes, in single or double precision, for
// the best instruction set of this machine.
#pragma once
#include "density/culling/units_simd.hpp"
#include <limits>

namespace molmesh::density {

/// log2 of what multiplies T^P along an axis, for P = 1: slope·(centroid - middle)·t + curvature·t², t = -3.5
/// … 3.5.
template <class T>
struct BlockShape {
  T middle[3]; ///< Å, relative to what the units' positions are
  T slope, curvature;
};

/// Factors of every row along x [8], and of y times z [64]. Each unit has a row for each atom and, when not direct,
/// one for what multiplies its power; scale, [units + 16], multiplies it everywhere.
template <class T>
struct BlockRows {
  AlignedVector<T> x, yz, scale;
  /// Where all units are roots: what multiplies each of them, which the rows are without; and of what curvature.
  alignas(64) T bend_x[8], bend_yz[64];
  T bent_by = std::numeric_limits<T>::quiet_NaN(); // of none yet
};
void make_rows(const BlockUnits& units, const BlockShape<float>& shape, BlockRows<float>& rows);
void make_rows(const ExactUnits& units, const BlockShape<double>& shape, BlockRows<double>& rows);

} // namespace molmesh::density
