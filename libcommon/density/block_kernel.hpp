// block_kernel.hpp — sums over atoms and their powers on the 8³ points of a block, in single precision, for the
// best instruction set of this machine (scalar, AVX2, AVX-512; chosen at run time). Error of a power: below 1e-6
// relative.
#pragma once
#include "density/units_kernel.hpp"

namespace molmesh::density {

/// log2 of what multiplies T^P along an axis, for P = 1: slope·(centroid - middle)·t + curvature·t², t = -3.5
/// … 3.5.
struct BlockShape {
  float middle[3]; ///< Å, relative to the node's middle
  float slope, curvature;
};

/// Factors of every row along x [8], and of y times z [64]. Each unit has a row for each atom and, unless units are
/// direct, one for what multiplies its power. Holds a row more than there are.
struct BlockRows {
  std::vector<float> x, yz;
};
void make_rows(const BlockUnits& units, const BlockShape& shape, BlockRows& rows);

/// sum[512] += S^P of units first … last - 1 at each point.
void add_units(const BlockUnits& units, const BlockRows& rows, int32_t first, int32_t last, float* sum);

/// to[512] += from^p, from = 0. Zero stays zero.
void raise_group(float p, float* from, float* to);

/// Name of the instruction set in use.
const char* instruction_set();

} // namespace molmesh::density
