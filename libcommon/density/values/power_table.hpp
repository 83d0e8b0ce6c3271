// power_table.hpp — what a vector needs for x^p: with x = m·2^e, 1 ≤ m < 2, a polynomial of m^p and tables of
// 2^(e·p).
#pragma once
#include <cstddef>

namespace molmesh::density {

/// Of 0 < p < 1, for positive normal x in single precision. Error of the power: below 4e-7, relative.
struct PowerTable {
  static constexpr size_t terms = 7;
  alignas(64) float low[16]; ///< 2^(p·i)
  float high[16];            ///< 2^(p·(16·i - 127)); e + 127 is 16 times the one index and the other
  float polynomial[terms];   ///< of m, the constant term first: interpolates m^p at Chebyshev's points
  float p = 0;
};

/// The same in double precision, m being c·(1 + r) with c the middle of its sixteenth of [1, 2). Error: below
/// 3e-11.
struct ExactPowerTable {
  static constexpr size_t terms = 6;
  alignas(64) double inverse[16]; ///< 1/c
  double middle[16];              ///< c^p
  double low[16], mid[16];        ///< 2^(p·i), 2^(p·16·i)
  double high[8];                 ///< 2^(p·(256·i - 1023))
  double polynomial[terms];       ///< of r: the binomial series of (1 + r)^p
  double p = 0;
};

/// Made when asked for first; a thread keeps some. Valid until the thread's next call of the same function.
const PowerTable& power_table(float p);
const ExactPowerTable& exact_power_table(double p);

} // namespace molmesh::density
