// power_table.cpp — Newton's form of the interpolant, then its powers.
#include "density/values/power_table.hpp"
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace molmesh::density {
namespace {

void make(PowerTable& t, float exponent) {
  constexpr size_t n = PowerTable::terms;
  const double p = exponent;
  double at[n], divided[n], sum[n] = {};
  for (size_t i = 0; i < n; ++i) {
    at[i] = 1.5 + 0.5 * std::cos(std::numbers::pi * (2 * double(i) + 1) / (2 * n));
    divided[i] = std::pow(at[i], p);
  }
  for (size_t k = 1; k < n; ++k)
    for (size_t i = n - 1; i >= k; --i)
      divided[i] = (divided[i] - divided[i - 1]) / (at[i] - at[i - k]);
  for (size_t k = n; k-- > 0;) { // sum = sum·(m - at[k]) + divided[k]
    for (size_t i = n - 1; i > 0; --i)
      sum[i] = sum[i - 1] - at[k] * sum[i];
    sum[0] = divided[k] - at[k] * sum[0];
  }
  for (size_t i = 0; i < n; ++i)
    t.polynomial[i] = static_cast<float>(sum[i]);
  for (int i = 0; i < 16; ++i) {
    t.low[i] = static_cast<float>(std::exp2(p * i));
    t.high[i] = static_cast<float>(std::exp2(p * (16 * i - 127)));
  }
  t.p = exponent;
}

} // namespace

const PowerTable& power_table(float p) {
  thread_local std::array<PowerTable, 64> kept;
  PowerTable& t = kept[std::bit_cast<uint32_t>(p) * 0x9e3779b9u >> 26];
  if (t.p != p)
    make(t, p);
  return t;
}

} // namespace molmesh::density
