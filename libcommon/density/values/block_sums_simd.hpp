// block_sums_simd.hpp — sums over atoms and their powers on the 8³ points of a block, in single or double
// precision, for the best instruction set of this machine (scalar, SSE4, AVX2, AVX-512; chosen at run time). Error
// of a power: below 1e-6 relative; in double precision below 1e-10.
#pragma once
#include "density/values/axis_factors_simd.hpp"

namespace molmesh::density {

/// sum[512] += S^P of units first … last - 1 at each point.
void add_units(const BlockUnits& units, const BlockRows<float>& rows, int32_t first, int32_t last, float* sum);
void add_units(const ExactUnits& units, const BlockRows<double>& rows, int32_t first, int32_t last, double* sum);

/// sum[512] = start + S^P of all units.
void sum_units(const BlockUnits& units, const BlockRows<float>& rows, float start, float* sum);
void sum_units(const ExactUnits& units, const BlockRows<double>& rows, double start, double* sum);

/// to[512] += 2^shift · from^p, from = 0. Zero stays zero.
void raise_group(float p, float shift, float* from, float* to);
void raise_group(double p, double shift, double* from, double* to);

/// Relative error of a root with BlockUnits::root = 0.
float rough_root_error();

/// Name of the instruction set in use.
const char* instruction_set();

} // namespace molmesh::density
