// log_sums_simd.hpp — sums over atoms and their powers on the 8³ points of a block, carried as logarithms to base
// 2, for the best instruction set of this machine. They hold where a double does not; error of a logarithm: 1e-11.
#pragma once
#include "density/values/axis_factors_simd.hpp"
#include <algorithm>

namespace molmesh::density {

/// At each point 2^largest · parts. `largest` is the logarithm of the largest term that was added. Points in 4³
/// cubes of 2³, in which the same atoms matter.
struct LogSums {
  /// Where a block has the i-th point: 64·x + 8·y + z.
  static constexpr int32_t slot(int32_t i) {
    const auto along = [i](int32_t axis) { return 2 * (i >> (7 - 2 * axis) & 3) + (i >> (2 - axis) & 1); };
    return 64 * along(0) + 8 * along(1) + along(2);
  }
  alignas(64) double largest[512], parts[512];
  LogSums() { clear(); }
  void clear() {
    std::fill_n(largest, 512, -1e290); // less than any logarithm, and finite when multiplied with an exponent
    std::fill_n(parts, 512, 1.0);
  }
};

struct LogScratch {
  LogSums t;                        ///< of the unit at work
  alignas(64) double sum[512] = {}; ///< of units whose parts doubles hold, by cubes
  AlignedVector<double> change, spread, middle, most;
  std::vector<int32_t> shown;
};

/// Adds S^P of units first … last - 1, of one group, at each point; where parts of their sum do not show, they are
/// left out: together at most `loss` of it, and of each S.
void add_log_units(const ExactUnits& units, const BlockShape<double>& shape, int32_t first, int32_t last,
                   double loss, LogScratch& scratch, LogSums& to);
/// to += from^p, from = 0.
void raise_log_group(double p, LogSums& from, LogSums& to);
/// sum[512] = start + what the logarithms are of.
void sums_of_logs(const LogSums& from, double start, float* sum);

} // namespace molmesh::density
