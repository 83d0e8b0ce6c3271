// lane_sums_simd.hpp — sums of terms known by their logarithms (to base 2) at eight places at a time, for the best
// instruction set of this machine. Error of a logarithm: 1e-11.
#pragma once
#include "base/aligned_vector.hpp"
#include <cstdint>

namespace molmesh::label {

/// Places side by side.
constexpr int lanes = 8;
struct LanePlaces {
  alignas(64) double x[lanes], y[lanes], z[lanes]; ///< Å
};

/// Sum s of `sums` is of atoms begin[s] … begin[s + 1], at least one; the logarithm of atom a's term is
/// peak[a] - decay·|p - (x, y, z)[a]|², decay in Å⁻². log2_sum[lanes·s + lane]; scratch grows.
struct LaneAtoms {
  AlignedVector<double> x, y, z, peak;
};
void sum_lane_atoms(const LaneAtoms& atoms, const int32_t* begin, int32_t sums, double decay, const LanePlaces& p,
                    AlignedVector<double>& scratch, double* log2_sum);

/// Sum s is of the powers of sums begin[s] … begin[s + 1] of the level below, at least one:
/// Σ_i 2^(exponent[i]·below[lanes·i + lane]).
void sum_lane_powers(const double* below, const double* exponent, const int32_t* begin, int32_t sums,
                     double* log2_sum);

} // namespace molmesh::label
