// device.cuh — the backend on one GPU: launches, scans and sorts of CUB, memory in stream order, checked calls,
// event times.
#pragma once
#include "cuda/par/backend.hpp"
#include "cuda/par/device.hpp"
#include <algorithm>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cuda_runtime.h>
#include <limits>
#include <memory>
#include <utility>

namespace molmesh::cuda {

/// Every call of CUDA goes through here: the ordinary one-line error.
inline void check(cudaError_t e, const char* what) {
  if (e != cudaSuccess)
    fail(Status::failed, std::string("GPU: ") + what + ": " + cudaGetErrorString(e));
}

/// The threads of a warp.
struct Warp {
  static constexpr int size = 32;
#ifdef __CUDACC__
  __device__ int rank() const {
    return static_cast<int>(threadIdx.x);
  }
  __device__ void sync() const {
    __syncwarp();
  }
#endif
};

namespace detail {

inline constexpr int threads_a_block = 256, warps_a_block = 4;

template <class Item>
__global__ void __launch_bounds__(threads_a_block) items(int64_t n, const Item item) {
  const int64_t i = int64_t{blockIdx.x} * threads_a_block + threadIdx.x;
  if (i < n)
    item(i);
}

template <class Item>
__global__ void __launch_bounds__(32 * warps_a_block) teams(int64_t n, const Item item) {
  __shared__ typename Item::Shared shared[warps_a_block];
  const int64_t i = int64_t{blockIdx.x} * warps_a_block + threadIdx.y;
  if (i < n)
    item(i, Warp{}, shared[threadIdx.y]);
}

template <class T>
__global__ void __launch_bounds__(threads_a_block) fill(int64_t n, T* to, T value) {
  const int64_t i = int64_t{blockIdx.x} * threads_a_block + threadIdx.x;
  if (i < n)
    to[i] = value;
}

struct StreamDelete {
  void operator()(cudaStream_t s) const { cudaStreamDestroy(s); }
};
struct EventDelete {
  void operator()(cudaEvent_t e) const { cudaEventDestroy(e); }
};
using Stream = std::unique_ptr<CUstream_st, StreamDelete>;
using Event = std::unique_ptr<CUevent_st, EventDelete>;

inline Stream make_stream() {
  cudaStream_t s{};
  check(cudaStreamCreateWithFlags(&s, cudaStreamNonBlocking), "a stream");
  return Stream(s);
}
inline Event make_event(unsigned flags) {
  cudaEvent_t e{};
  check(cudaEventCreateWithFlags(&e, flags), "an event");
  return Event(e);
}

} // namespace detail

/// One thread of the host uses it. Kernels run one after the other; copies to the host beside them.
class DeviceBackend {
public:
  DeviceBackend() {
    require_device();
    check(cudaSetDevice(0), "choosing the device");
    work_ = detail::make_stream();
    copy_ = detail::make_stream();
    cudaMemPool_t pool{};
    check(cudaDeviceGetDefaultMemPool(&pool, 0), "the memory pool");
    uint64_t all = std::numeric_limits<uint64_t>::max(); // freed memory stays ours until the end
    check(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &all), "the memory pool");
    size_t free = 0, total = 0;
    check(cudaMemGetInfo(&free, &total), "asking for its memory");
    budget_ = static_cast<int64_t>(free) / 10 * 9; // the rest: kernels' own, fragments
  }
  DeviceBackend(const DeviceBackend&) = delete;
  DeviceBackend& operator=(const DeviceBackend&) = delete;

  template <class T>
  using Array = OwnedArray<DeviceBackend, T>;

  /// A copy on its way to page-locked memory.
  template <class T>
  class Pending {
  public:
    Pending(DeviceBackend& owner, Array<T> from)
        : n_(from.size()), done_(detail::make_event(cudaEventDisableTiming)) {
      void* to = nullptr;
      check(cudaMallocHost(&to, std::max<size_t>(1, static_cast<size_t>(n_) * sizeof(T))), "page-locked memory");
      to_.reset(static_cast<T*>(to));
      check(cudaEventRecord(done_.get(), owner.work_.get()), "an event");
      check(cudaStreamWaitEvent(owner.copy_.get(), done_.get()), "an event");
      owner.copy_timed(to, from.data(), static_cast<size_t>(n_) * sizeof(T), cudaMemcpyDeviceToHost,
                       owner.copy_.get(), "copies to the host");
      check(cudaEventRecord(done_.get(), owner.copy_.get()), "an event");
      from_ = std::move(from);
    }
    Pending(Pending&&) noexcept = default;
    Pending& operator=(Pending&&) = delete;
    ~Pending() {
      if (done_)
        cudaEventSynchronize(done_.get());
    }
    const T* get() {
      check(cudaEventSynchronize(done_.get()), "copying to the host");
      from_ = {};
      return to_.get();
    }
    int64_t size() const { return n_; }

  private:
    struct HostFree {
      void operator()(T* p) const { cudaFreeHost(p); }
    };
    int64_t n_;
    detail::Event done_;
    std::unique_ptr<T[], HostFree> to_;
    Array<T> from_;
  };

  template <class T>
  Array<T> array(int64_t n) {
    return Array<T>(*this, n);
  }
  template <class T>
  Array<T> filled(int64_t n, T value) {
    Array<T> a(*this, n);
    launch("fill", n, {double(n) * sizeof(T)}, [&](unsigned blocks) {
      detail::fill<T><<<blocks, detail::threads_a_block, 0, work_.get()>>>(n, a.data(), value);
    });
    return a;
  }
  template <class T>
  Array<T> upload(const T* from, int64_t n) {
    Array<T> a(*this, n);
    copy_timed(a.data(), from, static_cast<size_t>(n) * sizeof(T), cudaMemcpyHostToDevice, work_.get(),
               "copies to the device");
    return a;
  }
  template <class T>
  void download(const Array<T>& from, int64_t n, T* to) {
    copy_timed(to, from.data(), static_cast<size_t>(n) * sizeof(T), cudaMemcpyDeviceToHost, work_.get(),
               "copies to the host");
    wait();
  }
  template <class T>
  Pending<T> fetch(Array<T> from) {
    return Pending<T>(*this, std::move(from));
  }

  template <class Item>
  void for_n(const char* name, int64_t n, const Item& item, const Work& work = {}) {
    launch(name, n, work, [&](unsigned blocks) {
      detail::items<Item><<<blocks, detail::threads_a_block, 0, work_.get()>>>(n, item);
    });
  }
  template <class Item>
  void for_teams(const char* name, int64_t n, const Item& item, const Work& work = {}) {
    if (n <= 0)
      return;
    const auto blocks = static_cast<unsigned>((n + detail::warps_a_block - 1) / detail::warps_a_block);
    timed(name, work,
          [&] { detail::teams<Item><<<blocks, dim3(32, detail::warps_a_block), 0, work_.get()>>>(n, item); });
  }
  template <class T>
  T scan(const char* name, T* count, int64_t n) {
    check(cudaMemsetAsync(count + n, 0, sizeof(T), work_.get()), name);
    size_t bytes = 0;
    check(cub::DeviceScan::ExclusiveSum(nullptr, bytes, count, count, n + 1, work_.get()), name);
    const Array<char> scratch(*this, static_cast<int64_t>(bytes));
    timed(name, {2.0 * double(n) * sizeof(T)}, [&] {
      check(cub::DeviceScan::ExclusiveSum(scratch.data(), bytes, count, count, n + 1, work_.get()), name);
    });
    T total{};
    check(cudaMemcpyAsync(&total, count + n, sizeof(T), cudaMemcpyDeviceToHost, work_.get()), name);
    wait();
    return total;
  }
  template <class K, class V>
  void sort_pairs(const char* name, K* keys, V* values, int64_t n) {
    if (n <= 1)
      return;
    const Array<K> other_keys(*this, n);
    const Array<V> other_values(*this, n);
    cub::DoubleBuffer<K> k(keys, other_keys.data());
    cub::DoubleBuffer<V> v(values, other_values.data());
    size_t bytes = 0;
    const int bits = 8 * static_cast<int>(sizeof(K));
    check(cub::DeviceRadixSort::SortPairs(nullptr, bytes, k, v, n, 0, bits, work_.get()), name);
    const Array<char> scratch(*this, static_cast<int64_t>(bytes));
    timed(name, {2.0 * double(n) * (sizeof(K) + sizeof(V))}, [&] {
      check(cub::DeviceRadixSort::SortPairs(scratch.data(), bytes, k, v, n, 0, bits, work_.get()), name);
    });
    copy_if_other(keys, k.Current(), n, name);
    copy_if_other(values, v.Current(), n, name);
  }

  int64_t room() const { return budget_ - used_; }
  int64_t most_used() const { return most_; }

  /// Waits for everything that was started.
  std::vector<KernelTime> times() {
    wait();
    check(cudaStreamSynchronize(copy_.get()), "copying to the host");
    for (const Launch& l : launches_) {
      float ms = 0;
      check(cudaEventElapsedTime(&ms, l.begin.get(), l.end.get()), "an event");
      add_time(times_, l.name, 1e-3 * ms, l.work);
    }
    launches_.clear();
    return times_;
  }

private:
  template <class, class>
  friend class cuda::OwnedArray;
  struct Launch {
    const char* name;
    detail::Event begin, end;
    Work work;
  };

  void* take(int64_t bytes) {
    if (bytes > room())
      throw OutOfRoom(bytes, room());
    void* p = nullptr;
    const cudaError_t e = cudaMallocAsync(&p, std::max<size_t>(1, static_cast<size_t>(bytes)), work_.get());
    if (e == cudaErrorMemoryAllocation) {
      cudaGetLastError();
      throw OutOfRoom(bytes, room());
    }
    check(e, "taking memory");
    used_ += bytes;
    most_ = std::max(most_, used_);
    return p;
  }
  void give_back(void* p, int64_t bytes) noexcept {
    used_ -= bytes;
    cudaFreeAsync(p, work_.get()); // an error here is an earlier one, told by the next checked call
  }
  void wait() { check(cudaStreamSynchronize(work_.get()), "running a kernel"); }

  template <class F>
  void timed(const char* name, const Work& work, F&& f) {
    Launch l{name, detail::make_event(cudaEventDefault), detail::make_event(cudaEventDefault), work};
    check(cudaEventRecord(l.begin.get(), work_.get()), "an event");
    f();
    check(cudaGetLastError(), name);
    check(cudaEventRecord(l.end.get(), work_.get()), "an event");
    launches_.push_back(std::move(l));
  }
  template <class F>
  void launch(const char* name, int64_t n, const Work& work, F&& f) {
    if (n <= 0)
      return;
    const int64_t blocks = (n + detail::threads_a_block - 1) / detail::threads_a_block;
    if (blocks > std::numeric_limits<int32_t>::max())
      fail(Status::failed, std::string("GPU: ") + name + ": too many items for one launch");
    timed(name, work, [&] { f(static_cast<unsigned>(blocks)); });
  }
  void copy_timed(void* to, const void* from, size_t bytes, cudaMemcpyKind kind, cudaStream_t stream,
                  const char* name) {
    if (bytes == 0)
      return;
    Launch l{name, detail::make_event(cudaEventDefault), detail::make_event(cudaEventDefault), {double(bytes)}};
    check(cudaEventRecord(l.begin.get(), stream), "an event");
    check(cudaMemcpyAsync(to, from, bytes, kind, stream), name);
    check(cudaEventRecord(l.end.get(), stream), "an event");
    launches_.push_back(std::move(l));
  }
  template <class T>
  void copy_if_other(T* to, const T* from, int64_t n, const char* name) {
    if (to != from)
      check(cudaMemcpyAsync(to, from, static_cast<size_t>(n) * sizeof(T), cudaMemcpyDeviceToDevice, work_.get()),
            name);
  }

  detail::Stream work_, copy_;
  int64_t budget_ = 0, used_ = 0, most_ = 0;
  std::vector<Launch> launches_;
  std::vector<KernelTime> times_;
};

} // namespace molmesh::cuda
