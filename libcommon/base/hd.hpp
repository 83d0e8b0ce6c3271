// hd.hpp — MOLMESH_HD marks functions that run on host and device; it is empty without nvcc.
#pragma once

#ifdef __CUDACC__
#define MOLMESH_HD __host__ __device__
#define MOLMESH_HD_CALL __host__ __device__ __noinline__ // large bodies called from several places: nvcc's time
#else
#define MOLMESH_HD
#define MOLMESH_HD_CALL
#endif
