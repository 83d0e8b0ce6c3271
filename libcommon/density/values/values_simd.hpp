// values_simd.hpp — the 512 values of a block: rounded, put on sides of the band, packed; vectorized for the best
// instruction set of this machine. Masks [8]: bit 8·j + k of word i.
#pragma once
#include <cstdint>

namespace molmesh::density {

/// Rounds v[512] to nearest with the last `bits` bits zero, for files that compress: a relative error of at most
/// 2^(bits - 24). 0 bits: nothing.
void round_values(float* v, int bits);

struct Limits {
  float lower, upper;
};
/// Bit 8·j + k of word i.
struct SideWords {
  uint64_t *below, *above;
};
/// After round_values(): where each of the 512 values of a block is below `near.lower`, above `near.upper`, and so
/// for `far`.
void classify_points(float* v, int bits, Limits near, Limits far, SideWords near_words, SideWords far_words);

/// Copies the v whose bit of active[8] is set to out, in order; may write up to 16 values more. Returns how many.
int32_t pack_active(const float* v, const uint64_t* active, float* out);

/// packed: the values of the points stored[8], in order; up to 16 floats behind them are read. Copies those of
/// active[8], a subset, to out; may write up to 16 values more. Returns how many.
int32_t pack_part(const float* packed, const uint64_t* stored, const uint64_t* active, float* out);

} // namespace molmesh::density
