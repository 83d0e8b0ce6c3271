// hd.hpp — HD marks functions that run on host and device; it is empty without nvcc.
#pragma once

#ifdef __CUDACC__
#define HD __host__ __device__
#define HD_CALL __host__ __device__ __noinline__ // large bodies called from several places: nvcc's time
#else
#define HD
#define HD_CALL
#endif
