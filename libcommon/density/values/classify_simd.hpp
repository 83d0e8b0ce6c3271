// classify_simd.hpp — rounds the 512 values of a block and tells which side of the band each is on, vectorized for
// the best instruction set of this machine. Masks [8]: bit 8·j + k of word i.
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

} // namespace molmesh::density
