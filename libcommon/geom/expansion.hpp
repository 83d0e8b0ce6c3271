// expansion.hpp — exact sums and products of doubles as sums of non-overlapping doubles. Host and device.
// Dekker 1971, Knuth TAOCP 2 §4.2.2; growing an expansion by one term as in Shewchuk 1997 (theorem 10).
#pragma once
#include "base/hd.hpp"
#include <cmath>

namespace molmesh {

/// a + b = sum + error, exactly (barring overflow).
struct TwoTerms {
  double sum, error;
};

MOLMESH_HD inline TwoTerms two_sum(double a, double b) {
  const double sum = a + b, b_part = sum - a, a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}
/// a · b = sum + error, exactly when it is a multiple of 2^-1074 and does not overflow.
MOLMESH_HD inline TwoTerms two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

/// A number as the exact sum of at most N doubles: non-overlapping, by increasing magnitude, none zero.
template <int N>
struct Expansion {
  double term[N];
  int size = 0;

  MOLMESH_HD void add(double b) {
    int kept = 0;
    for (int i = 0; i < size; ++i) {
      const TwoTerms t = two_sum(b, term[i]);
      if (t.error != 0)
        term[kept++] = t.error;
      b = t.sum;
    }
    if (b != 0)
      term[kept++] = b;
    size = kept;
  }
  MOLMESH_HD void add_product(double a, double b) {
    const TwoTerms t = two_product(a, b);
    add(t.error);
    add(t.sum);
  }
  /// Of the exact value: the largest term outweighs the others together.
  MOLMESH_HD int sign() const { return size == 0 ? 0 : term[size - 1] > 0 ? 1 : -1; }
};

} // namespace molmesh
