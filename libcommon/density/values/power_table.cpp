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

void make(ExactPowerTable& t, double p) {
  for (int i = 0; i < 16; ++i) {
    const double c = 1 + (i + 0.5) / 16;
    t.inverse[i] = 1 / c;
    t.middle[i] = std::pow(c, p);
    t.low[i] = std::exp2(p * i);
    t.mid[i] = std::exp2(p * 16 * i);
  }
  for (int i = 0; i < 8; ++i)
    t.high[i] = std::exp2(p * (256 * i - 1023));
  t.polynomial[0] = 1;
  for (size_t k = 1; k < ExactPowerTable::terms; ++k)
    t.polynomial[k] = t.polynomial[k - 1] * (p - double(k) + 1) / double(k);
  t.p = p;
}

} // namespace

const PowerTable& power_table(float p) {
  thread_local std::array<PowerTable, 64> kept;
  PowerTable& t = kept[std::bit_cast<uint32_t>(p) * 0x9e3779b9u >> 26];
  if (t.p != p)
    make(t, p);
  return t;
}

const ExactPowerTable& exact_power_table(double p) {
  thread_local std::array<ExactPowerTable, 32> kept;
  ExactPowerTable& t = kept[std::bit_cast<uint64_t>(p) * 0x9e3779b97f4a7c15u >> 59];
  if (t.p != p)
    make(t, p);
  return t;
}

} // namespace molmesh::density
