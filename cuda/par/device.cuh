// device.cuh — the backend on one GPU: launches, scans and sorts of CUB, event times.
#pragma once
#include "cuda/par/device_memory.cuh"
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace molmesh::cuda {

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
  template <class T>
  __device__ T least(T mine) const {
    for (int far = 16; far > 0; far /= 2) {
      const T other = __shfl_xor_sync(0xFFFFFFFFu, mine, far);
      mine = other < mine ? other : mine;
    }
    return mine;
  }
  template <class T>
  __device__ T sum(T mine) const {
    for (int far = 16; far > 0; far /= 2)
      mine += __shfl_xor_sync(0xFFFFFFFFu, mine, far);
    return mine;
  }
  __device__ int before(bool mine, int& all) const {
    const unsigned yes = __ballot_sync(0xFFFFFFFFu, mine);
    all = __popc(yes);
    return __popc(yes & ((1u << rank()) - 1));
  }
#endif
};

namespace detail {

inline constexpr int threads_a_block = 256, warps_a_block = 4;

template <class Item>
__global__ void __launch_bounds__(threads_a_block) items(int64_t n, const __grid_constant__ Item item) {
  const int64_t i = int64_t{blockIdx.x} * threads_a_block + threadIdx.x;
  if (i < n)
    item(i);
}

template <class Item>
__global__ void __launch_bounds__(32 * warps_a_block) teams(int64_t n, const __grid_constant__ Item item) {
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

} // namespace detail

/// One thread of the host uses it, and one more fetches what is settled. Kernels run one after the other; copies to
/// the host beside them.
class DeviceBackend {
public:
  /// most: bytes of the device's memory that may be taken; 0: nine tenths of what is free. pages: what does not fit
  /// goes to the host's memory.
  explicit DeviceBackend(int64_t most, bool pages = false) {
    require_device();
    check(cudaSetDevice(0), "choosing the device");
    work_ = detail::make_stream();
    copy_ = detail::make_stream();
    memory_.emplace(work_.get(), copy_.get(), most, pages);
  }
  DeviceBackend(const DeviceBackend&) = delete;
  DeviceBackend& operator=(const DeviceBackend&) = delete;

  template <class T>
  using Array = OwnedArray<DeviceMemory, T>;

  /// A copy on its way to page-locked memory.
  template <class T>
  class Pending {
  public:
    Pending(DeviceBackend& owner, const T* from, int64_t n, bool is_settled)
        : n_(n), done_(detail::make_event(cudaEventDisableTiming)),
          to_(owner.locked_, static_cast<size_t>(n_) * sizeof(T)) {
      try {
        if (!is_settled) {
          check(cudaEventRecord(done_.get(), owner.work_.get()), "an event");
          check(cudaStreamWaitEvent(owner.copy_.get(), done_.get()), "an event");
        }
        owner.copy_timed(to_.data(), from, static_cast<size_t>(n_) * sizeof(T), owner.copy_.get(),
                         "copies to the host");
        check(cudaEventRecord(done_.get(), owner.copy_.get()), "an event");
      } catch (...) { // the page-locked memory stays until the copy is over
        cudaStreamSynchronize(owner.copy_.get());
        throw;
      }
    }
    Pending(Pending&&) noexcept = default;
    Pending& operator=(Pending&&) = delete;
    ~Pending() {
      if (done_)
        cudaEventSynchronize(done_.get());
    }
    const T* get() const {
      check(cudaEventSynchronize(done_.get()), "copying to the host");
      return static_cast<const T*>(to_.data());
    }
    int64_t size() const { return n_; }

  private:
    int64_t n_;
    detail::Event done_;
    detail::Locked to_;
  };

  template <class T>
  Array<T> array(int64_t n) {
    return Array<T>(*memory_, n);
  }
  template <class T>
  Array<T> filled(int64_t n, T value) {
    Array<T> a(*memory_, n);
    launch("fill", n, {double(n) * sizeof(T)}, [&](unsigned blocks) {
      detail::fill<T><<<blocks, detail::threads_a_block, 0, work_.get()>>>(n, a.data(), value);
    });
    return a;
  }
  template <class T>
  Array<T> upload(const T* from, int64_t n) {
    Array<T> a(*memory_, n);
    copy_timed(a.data(), from, static_cast<size_t>(n) * sizeof(T), work_.get(), "copies to the device");
    wait(); // `from` may go
    return a;
  }
  template <class T>
  void download(const Array<T>& from, int64_t n, T* to) {
    copy_timed(to, from.data(), static_cast<size_t>(n) * sizeof(T), work_.get(), "copies to the host");
    wait();
  }
  template <class T>
  Pending<T> fetch(const T* from, int64_t n, bool is_settled = false) {
    return Pending<T>(*this, from, n, is_settled);
  }
  void settle() { wait(); }

  template <class Item>
  void for_n(const char* name, int64_t n, const Item& item, const Work& work = {}) {
    launch(name, n, work, [&](unsigned blocks) {
      detail::items<Item><<<blocks, detail::threads_a_block, 0, work_.get()>>>(n, item);
    });
  }
  template <class Item>
  void for_teams(const char* name, int64_t n, const Item& item, const Work& work = {}) {
    launch(
        name, n, work,
        [&](unsigned blocks) {
          detail::teams<Item><<<blocks, dim3(32, detail::warps_a_block), 0, work_.get()>>>(n, item);
        },
        detail::warps_a_block);
  }
  template <class T>
  T scan(const char* name, T* count, int64_t n) {
    check_length(name, n + 1);
    check(cudaMemsetAsync(count + n, 0, sizeof(T), work_.get()), name);
    size_t bytes = 0;
    check(cub::DeviceScan::ExclusiveSum(nullptr, bytes, count, count, n + 1, work_.get()), name);
    const Array<char> scratch(*memory_, static_cast<int64_t>(bytes));
    timed(name, n, {2.0 * double(n) * sizeof(T)}, [&] {
      check(cub::DeviceScan::ExclusiveSum(scratch.data(), bytes, count, count, n + 1, work_.get()), name);
    });
    T total{};
    check(cudaMemcpyAsync(&total, count + n, sizeof(T), cudaMemcpyDefault, work_.get()), name);
    wait();
    return total;
  }
  template <class K, class V>
  void sort_pairs(const char* name, K* keys, V* values, int64_t n) {
    if (n <= 1)
      return;
    check_length(name, n);
    const Array<K> other_keys(*memory_, n);
    const Array<V> other_values(*memory_, n);
    cub::DoubleBuffer<K> k(keys, other_keys.data());
    cub::DoubleBuffer<V> v(values, other_values.data());
    size_t bytes = 0;
    const int bits = 8 * static_cast<int>(sizeof(K));
    check(cub::DeviceRadixSort::SortPairs(nullptr, bytes, k, v, n, 0, bits, work_.get()), name);
    const Array<char> scratch(*memory_, static_cast<int64_t>(bytes));
    timed(name, n, {2.0 * double(n) * (sizeof(K) + sizeof(V))}, [&] {
      check(cub::DeviceRadixSort::SortPairs(scratch.data(), bytes, k, v, n, 0, bits, work_.get()), name);
    });
    copy_if_other(keys, k.Current(), n, name);
    copy_if_other(values, v.Current(), n, name);
  }

  void plan(int64_t bytes) { memory_->plan(bytes); }
  int64_t room() const { return memory_->room(); }
  Bytes most_used() const { return memory_->most_used(); }

  /// Waits for everything that was started.
  std::vector<KernelTime> times() {
    wait();
    check(cudaStreamSynchronize(copy_.get()), "copying to the host");
    for (const Launch& l : launches_) {
      float ms = 0;
      check(cudaEventElapsedTime(&ms, l.begin.get(), l.end.get()), "an event");
      add_time(times_, l.name, l.items, 1e-3 * ms, l.work);
    }
    launches_.clear();
    return times_;
  }

private:
  struct Launch {
    const char* name;
    int64_t items;
    detail::Event begin, end;
    Work work;
  };

  /// CUB counted in 32 bits once; 13 is what is known to count in 64.
  static void check_length([[maybe_unused]] const char* name, [[maybe_unused]] int64_t n) {
#if CUDART_VERSION < 13000
    if (n > std::numeric_limits<int32_t>::max())
      fail(Status::failed, std::string("GPU: ") + name + ": too many items for a build with CUDA before 13");
#endif
  }
  void wait() {
    check(cudaStreamSynchronize(work_.get()), "running a kernel");
  }

  void add(Launch l) { // by whoever fetches, too
    const std::lock_guard guard(adding_);
    launches_.push_back(std::move(l));
  }
  template <class F>
  void timed(const char* name, int64_t items, const Work& work, F&& f) {
    Launch l{name, items, detail::make_event(cudaEventDefault), detail::make_event(cudaEventDefault), work};
    check(cudaEventRecord(l.begin.get(), work_.get()), "an event");
    f();
    check(cudaGetLastError(), name);
    check(cudaEventRecord(l.end.get(), work_.get()), "an event");
    add(std::move(l));
  }
  template <class F>
  void launch(const char* name, int64_t n, const Work& work, F&& f, int items_a_block = detail::threads_a_block) {
    if (n <= 0)
      return;
    const int64_t blocks = (n + items_a_block - 1) / items_a_block;
    if (blocks > std::numeric_limits<int32_t>::max())
      fail(Status::failed, std::string("GPU: ") + name + ": too many items for one launch");
    timed(name, n, work, [&] { f(static_cast<unsigned>(blocks)); });
  }
  /// Where pages do not move, arrays may be the host's memory: the driver knows from the addresses.
  void copy_timed(void* to, const void* from, size_t bytes, cudaStream_t stream, const char* name) {
    if (bytes == 0)
      return;
    Launch l{name, 1, detail::make_event(cudaEventDefault), detail::make_event(cudaEventDefault), {double(bytes)}};
    check(cudaEventRecord(l.begin.get(), stream), "an event");
    check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, stream), name);
    check(cudaEventRecord(l.end.get(), stream), "an event");
    add(std::move(l));
  }
  template <class T>
  void copy_if_other(T* to, const T* from, int64_t n, const char* name) {
    if (to != from)
      check(cudaMemcpyAsync(to, from, static_cast<size_t>(n) * sizeof(T), cudaMemcpyDefault, work_.get()), name);
  }

  detail::Stream work_, copy_;
  detail::LockedPool locked_;
  std::optional<DeviceMemory> memory_;
  std::mutex adding_;
  std::vector<Launch> launches_;
  std::vector<KernelTime> times_;
};

static_assert(par::Launcher<DeviceBackend>);

} // namespace molmesh::cuda
