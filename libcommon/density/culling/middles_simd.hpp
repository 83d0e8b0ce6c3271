// middles_simd.hpp — evaluates the sums of units in the middle of a block, and the slope of their powers there, in
// single precision, for the best instruction set of this machine. Logarithms are to base 2.
#pragma once
#include "density/culling/units_simd.hpp"

namespace molmesh::density {

/// log2 S in the middle of the block, and the mean of the atoms' positions weighted with their terms there, Å.
struct UnitMiddles {
  AlignedFloats log2_sum, x, y, z; ///< [n + 16]
};
void unit_middles(const BlockUnits& units, const LocalBox& block, float decay, UnitMiddles& to);

/// Σ S^P at the block's middle from such sums and means, and its gradient, Å⁻¹. Arrays hold n + 16.
void sum_of_powers(int32_t n, const float* exponent, const float* log2_sum, const float* x, const float* y,
                   const float* z, const LocalBox& block, float decay, float* value, float* gradient);

} // namespace molmesh::density
