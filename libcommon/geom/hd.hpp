// hd.hpp — HD marks functions that run on host and device; it is empty without nvcc.
#pragma once

#ifdef __CUDACC__
#define HD __host__ __device__
#else
#define HD
#endif
