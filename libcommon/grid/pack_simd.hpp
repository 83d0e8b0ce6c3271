// pack_simd.hpp — packs the values of some of a block's 512 points, vectorized for the best instruction set of this
// machine. Masks [8]: bit 8·j + k of word i.
#pragma once
#include <cstdint>

namespace molmesh {

/// Copies the v whose bit of active[8] is set to out, in order; may write up to 16 values more. Returns how many.
int32_t pack_active(const float* v, const uint64_t* active, float* out);

/// packed: the values of the points stored[8], in order; up to 16 floats behind them are read. Copies those of
/// active[8], a subset, to out; may write up to 16 values more. Returns how many.
int32_t pack_part(const float* packed, const uint64_t* stored, const uint64_t* active, float* out);

} // namespace molmesh
