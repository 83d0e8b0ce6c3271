// run_copy.hpp — copies arrays to the host in runs: one run is copied while the next is made.
#pragma once
#include "cuda/par/backend.hpp"
#include "cuda/par/copy_bytes.hpp"
#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

namespace molmesh::cuda {

/// The page-locked memory in use is two runs, however long the arrays: locking as much as is copied costs as much
/// as the copy.
template <class Backend>
class RunCopy {
public:
  /// Larger runs take longer to lock than to copy.
  static constexpr int64_t usual_bytes = int64_t{4} << 20;
  /// threads: of the host, from page-locked memory on. run_bytes: of a run. is_settled: what is sent is, and this
  /// is another thread than the Backend's.
  RunCopy(Backend& b, int threads, int64_t run_bytes = usual_bytes, bool is_settled = false)
      : b_(b), threads_(threads), run_bytes_(run_bytes), is_settled_(is_settled) {}

  /// to[0, n) will be from[0, n). make(begin, end) starts what writes from[begin, end) last. Both arrays stay until
  /// finish().
  template <class T, class Make>
  void send(const T* from, int64_t n, T* to, Make&& make) {
    const int64_t run = std::max<int64_t>(run_bytes_ / static_cast<int64_t>(sizeof(T)), 1);
    for (int64_t begin = 0; begin < n; begin += run) {
      const int64_t end = std::min(n, begin + run);
      make(begin, end);
      Pending next = b_.fetch(reinterpret_cast<const std::byte*>(from + begin),
                              (end - begin) * static_cast<int64_t>(sizeof(T)), is_settled_);
      finish(); // the run before, while this one is on its way
      last_ = std::make_unique<Pending>(std::move(next));
      to_ = reinterpret_cast<std::byte*>(to + begin);
    }
  }
  template <class T>
  void send(const T* from, int64_t n, T* to) {
    send(from, n, to, [](int64_t, int64_t) {});
  }
  /// Returns when all that was sent is there.
  void finish() {
    if (!last_)
      return;
    copy_bytes(last_->get(), last_->size(), to_, threads_);
    last_.reset();
  }

private:
  using Pending = typename Backend::template Pending<std::byte>;
  Backend& b_;
  int threads_;
  int64_t run_bytes_;
  bool is_settled_;
  std::unique_ptr<Pending> last_;
  std::byte* to_ = nullptr;
};

} // namespace molmesh::cuda
