// peaks.hpp — what this card reaches: the floor that kernels are measured against.
#pragma once

namespace molmesh::gpu {

struct Peaks {
  double bytes = 0, single = 0, in_double = 0; ///< a second: moved, multiply-adds in single and double precision
};
/// Measured: a copy of 256 MiB, and chains of multiply-adds without memory.
Peaks measure_peaks();

} // namespace molmesh::gpu
