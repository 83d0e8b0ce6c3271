// logs_simd.hpp — computes log G of 64 grid points, vectorized for the best instruction set of this machine.
#pragma once
#include <cstdint>

namespace molmesh {

/// portable_log(value[i] / isovalue), rounded to single precision, where bit i of `active` is set and the value is
/// positive; NaN elsewhere. value, out: [64]
void log_ratios(const float* value, uint64_t active, double isovalue, float* out);

} // namespace molmesh
