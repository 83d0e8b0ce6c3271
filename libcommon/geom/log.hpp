// log.hpp — the natural logarithm by additions, multiplications and one division: the same bits on every machine,
// host and device. Libraries differ in the last bit, and a mesh must not depend on whose it was.
#pragma once
#include "geom/hd.hpp"
#include <cmath>

namespace molmesh {

/// x finite, normal and positive; within 2e-16 of |ln x| + 1. Needs IEEE arithmetic without contraction.
HD inline double portable_log(double x) {
  int exponent;
  double m = std::frexp(x, &exponent); // in [1/2, 1)
  if (m < 0.70710678118654752) {
    m *= 2;
    --exponent;
  }
  // ln m = 2 artanh(s), |s| ≤ 0.172: the next term is below 2e-18.
  const double s = (m - 1) / (m + 1), t = s * s;
  double p = 1.0 / 21;
  p = p * t + 1.0 / 19;
  p = p * t + 1.0 / 17;
  p = p * t + 1.0 / 15;
  p = p * t + 1.0 / 13;
  p = p * t + 1.0 / 11;
  p = p * t + 1.0 / 9;
  p = p * t + 1.0 / 7;
  p = p * t + 1.0 / 5;
  p = p * t + 1.0 / 3;
  const double ln_m = 2 * s + 2 * s * (t * p);
  // ln 2 in two parts, the first with so few bits that its product with the exponent is exact.
  constexpr double high = 0x1.62e42fee00000p-1, low = 0x1.a39ef35793c76p-33;
  return exponent * high + (ln_m + exponent * low);
}

} // namespace molmesh
