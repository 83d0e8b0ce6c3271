// rows_kernel.hpp — factors of the atoms of a block along its axes, in single precision, for the best instruction
// set of this machine.
#pragma once
#include "density/units_kernel.hpp"

namespace molmesh::density {

/// log2 of what multiplies T^P along an axis, for P = 1: slope·(centroid - middle)·t + curvature·t², t = -3.5
/// … 3.5.
struct BlockShape {
  float middle[3]; ///< Å, relative to the node's middle
  float slope, curvature;
};

/// Factors of every row along x [8], and of y times z [64]. Each unit has a row for each atom and one for what
/// multiplies its power; when units are direct that is its scale alone, [units + 16].
struct BlockRows {
  Floats x, yz, scale;
};
void make_rows(const BlockUnits& units, const BlockShape& shape, BlockRows& rows);

} // namespace molmesh::density
