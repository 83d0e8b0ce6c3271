// bits.hpp — counts and finds the bits of a word. Host and device.
#pragma once
#include "base/hd.hpp"
#include <cstdint>

namespace molmesh {

/// std::popcount is a call into a table where the processor's own instruction may not be assumed.
MOLMESH_HD constexpr int count_bits(uint64_t x) {
  x -= x >> 1 & 0x5555555555555555u;
  x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
  x = (x + (x >> 4)) & 0x0F0F0F0F0F0F0F0Fu;
  return static_cast<int>(x * 0x0101010101010101u >> 56);
}

/// Place of the lowest bit; x ≠ 0.
MOLMESH_HD inline int lowest_bit(uint64_t x) {
#ifdef __CUDA_ARCH__
  return __ffsll(static_cast<long long>(x)) - 1;
#else
  return __builtin_ctzll(x);
#endif
}

} // namespace molmesh
