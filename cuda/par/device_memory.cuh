// device_memory.cuh — allocates the device's memory in the order of a stream, and pages of the host beside it.
#pragma once
#include "cuda/par/backend.hpp"
#include "cuda/par/device.hpp"
#include "cuda/par/handles.cuh"
#include <cstdlib>
#include <limits>

namespace molmesh::cuda {

class DeviceMemory {
public:
  /// Work on `copy` is waited for before pages are given back. most, pages: as DeviceBackend has them.
  DeviceMemory(cudaStream_t work, cudaStream_t copy, int64_t most, bool pages) : work_(work), copy_(copy) {
    check(cudaDeviceSynchronize(), "running a kernel");
    keep_freed(0); // what a backend before this one had
    size_t free = 0, total = 0;
    check(cudaMemGetInfo(&free, &total), "asking for its memory");
    const int64_t own = static_cast<int64_t>(free) / 10 * 9; // the rest: kernels' own, fragments
    ledger_ = Ledger({most > 0 ? std::min(most, own) : own, pages ? free_host_memory() / 10 * 9 : 0});
    int moves = 0;
    check(cudaDeviceGetAttribute(&moves, cudaDevAttrConcurrentManagedAccess, 0), "asking for its memory");
    pages_move_ = moves != 0 && !std::getenv("MOLMESH_LOCKED_PAGES");
    keep_freed(std::numeric_limits<uint64_t>::max());
  }
  DeviceMemory(const DeviceMemory&) = delete;
  DeviceMemory& operator=(const DeviceMemory&) = delete;

  Taken take(int64_t bytes) {
    Taken t{nullptr, ledger_.is_paged(bytes)};
    const auto size = std::max<size_t>(1, static_cast<size_t>(bytes));
    cudaError_t e = t.paged ? take_paged(&t.data, size) : cudaMallocAsync(&t.data, size, work_);
    if (e == cudaErrorMemoryAllocation && !t.paged && ledger_.has_pages(bytes)) { // in pieces
      cudaGetLastError();
      t.paged = true;
      e = take_paged(&t.data, size);
    }
    if (e == cudaErrorMemoryAllocation) {
      cudaGetLastError();
      throw OutOfRoom(bytes, room());
    }
    check(e, "taking memory");
    ledger_.add(bytes, t.paged);
    return t;
  }
  /// An error here is an earlier one, told by the next checked call.
  void give_back(Taken t, int64_t bytes) noexcept {
    ledger_.subtract(bytes, t.paged);
    if (!t.paged) {
      cudaFreeAsync(t.data, work_);
      return;
    }
    cudaStreamSynchronize(work_);
    cudaStreamSynchronize(copy_);
    pages_move_ ? cudaFree(t.data) : cudaFreeHost(t.data);
  }
  void plan(int64_t bytes) { ledger_.plan(bytes); }
  int64_t room() const { return ledger_.room(); }
  Bytes most_used() const { return ledger_.most_used(); }

private:
  /// Of what is freed, so much stays ours: taking it again costs nothing.
  static void keep_freed(uint64_t bytes) {
    cudaMemPool_t pool{};
    check(cudaDeviceGetDefaultMemPool(&pool, 0), "the memory pool");
    check(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &bytes), "the memory pool");
    check(cudaMemPoolTrimTo(pool, static_cast<size_t>(std::min<uint64_t>(bytes, SIZE_MAX))), "the memory pool");
  }
  /// Pages that move between host and device as kernels ask for them, where the device can do that (Linux) and
  /// MOLMESH_LOCKED_PAGES is not set; else page-locked memory that kernels reach into.
  cudaError_t take_paged(void** to, size_t bytes) {
    if (!has_paged_) { // what is freed from now on is the pages'
      has_paged_ = true;
      check(cudaStreamSynchronize(work_), "running a kernel");
      keep_freed(0);
    }
    if (pages_move_) {
      const cudaError_t e = cudaMallocManaged(to, bytes);
      has_moving_ = has_moving_ || e == cudaSuccess;
      if (has_moving_ || e == cudaErrorMemoryAllocation)
        return e;
      cudaGetLastError(); // a sandbox may have none; nothing is to be given back as such
      pages_move_ = false;
    }
    return cudaHostAlloc(to, bytes, cudaHostAllocMapped);
  }

  cudaStream_t work_, copy_;
  Ledger ledger_{{0, 0}};
  bool pages_move_ = false, has_paged_ = false, has_moving_ = false;
};

} // namespace molmesh::cuda
