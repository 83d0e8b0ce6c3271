// helpers.hpp — lets threads that have run out of items help those that still work on one.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

namespace molmesh::par {

/// Shared by the threads of one loop. Each takes its items while it has a Busy, and calls help() after.
class Helpers {
public:
  class Busy {
  public:
    explicit Busy(Helpers& helpers);
    ~Busy();
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

  private:
    Helpers& helpers_;
  };
  /// Whether a thread waits in help().
  bool any_idle() const { return idle_.load(std::memory_order_relaxed) > 0; }
  /// own() on this thread, and meanwhile theirs() on every thread that waits in help(), or comes to. Each returns
  /// when nothing of the work is left to begin. Returns when all have.
  void share(const std::function<void()>& own, const std::function<void()>& theirs);
  /// Takes part in what is shared until no thread is busy.
  void help();

private:
  struct Shared {
    const std::function<void()>& task;
    int inside = 0;
  };
  void close(const Shared& s); ///< no more threads; guard_ is held

  std::mutex guard_;
  std::condition_variable change_;
  std::vector<Shared*> open_;
  int busy_ = 0;
  std::atomic<int> idle_{0};
};

} // namespace molmesh::par
