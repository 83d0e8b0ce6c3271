// log.hpp — the natural logarithm by additions, multiplications and one division: the same bits on every machine,
// host and device. Libraries differ in the last bit, and a mesh must not depend on whose it was.
#pragma once
#include "base/hd.hpp"
#include <bit>
#include <cstdint>

namespace molmesh {

/// As portable_log. V: double, or one of the compiler's vectors of them, U: its bits. By reference: what vectors
/// look like as arguments depends on the processor.
template <class V, class U>
MOLMESH_HD __attribute__((always_inline)) inline void portable_logs(const V& x, V& log) {
  // By the bits and without branches, so that loops over it are vectors. m in [0.707, 1.414), x = 2^exponent m.
  constexpr uint64_t mantissa = (uint64_t{1} << 52) - 1;
  constexpr uint64_t root_half = std::bit_cast<uint64_t>(0.70710678118654752) & mantissa;
  const U bits = __builtin_bit_cast(U, x);
  const U below = ((bits & mantissa) - root_half) >> 63;
  const V m = __builtin_bit_cast(V, (bits & mantissa) | (0x3FE + below) << 52);
  const V exponent = __builtin_bit_cast(V, ((bits >> 52) - below) | 0x4330000000000000u) - (0x1p52 + 1022);
  // ln m = 2 artanh(s), |s| ≤ 0.172: the next term is below 2e-18.
  const V s = (m - 1) / (m + 1), t = s * s;
  V p = V{} + 1.0 / 21;
  p = p * t + 1.0 / 19;
  p = p * t + 1.0 / 17;
  p = p * t + 1.0 / 15;
  p = p * t + 1.0 / 13;
  p = p * t + 1.0 / 11;
  p = p * t + 1.0 / 9;
  p = p * t + 1.0 / 7;
  p = p * t + 1.0 / 5;
  p = p * t + 1.0 / 3;
  const V ln_m = 2 * s + 2 * s * (t * p);
  // ln 2 in two parts, the first with so few bits that its product with the exponent is exact.
  constexpr double high = 0x1.62e42fee00000p-1, low = 0x1.a39ef35793c76p-33;
  log = exponent * high + (ln_m + exponent * low);
}

/// x finite, normal and positive; within 2e-16 of |ln x| + 1. Needs IEEE arithmetic without contraction.
MOLMESH_HD inline double portable_log(double x) {
  double log;
  portable_logs<double, uint64_t>(x, log);
  return log;
}

} // namespace molmesh
