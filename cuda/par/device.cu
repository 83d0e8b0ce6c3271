// device.cu — asks the driver for the device and the host's memory, once.
#include "base/error.hpp"
#include "base/memory.hpp"
#include "cuda/par/device.hpp"
#include <algorithm>
#include <cuda_runtime.h>

namespace molmesh::cuda {

void require_device() {
  int n = 0;
  const cudaError_t e = cudaGetDeviceCount(&n);
  if (e != cudaSuccess || n == 0)
    fail(Status::mode_unavailable,
         std::string("mode cuda: no GPU here (") + (e == cudaSuccess ? "no device" : cudaGetErrorString(e)) +
             "), use seq or omp",
         {"mode"});
  int major = 0, minor = 0;
  if (cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, 0) != cudaSuccess ||
      cudaDeviceGetAttribute(&minor, cudaDevAttrComputeCapabilityMinor, 0) != cudaSuccess)
    fail(Status::mode_unavailable, "mode cuda: the GPU does not answer, use seq or omp", {"mode"});
  if (10 * major + minor < 75)
    fail(Status::mode_unavailable,
         "mode cuda: found a GPU of compute capability " + std::to_string(major) + "." + std::to_string(minor) +
             ", expected 7.5 or higher; use seq or omp",
         {"mode"});
  int has_pools = 0;
  if (cudaDeviceGetAttribute(&has_pools, cudaDevAttrMemoryPoolsSupported, 0) != cudaSuccess || has_pools == 0)
    fail(Status::mode_unavailable, "mode cuda: found a GPU without memory pools, use seq or omp", {"mode"});
}

int64_t device_memory() {
  try {
    require_device();
  } catch (const Error&) {
    return 0;
  }
  size_t free = 0, all = 0;
  return cudaMemGetInfo(&free, &all) == cudaSuccess ? static_cast<int64_t>(all) : 0;
}

std::string device_name() {
  require_device();
  cudaDeviceProp p{};
  if (cudaGetDeviceProperties(&p, 0) != cudaSuccess)
    fail(Status::mode_unavailable, "mode cuda: the GPU does not answer, use seq or omp", {"mode"});
  return std::string(p.name) + ", " + std::to_string(p.multiProcessorCount) + " multiprocessors, " +
         std::to_string(p.totalGlobalMem >> 30) + " GiB";
}

int64_t free_host_memory() {
  return std::max<int64_t>(0, memory_at_hand({}, Swap::is_no_use));
}

} // namespace molmesh::cuda
