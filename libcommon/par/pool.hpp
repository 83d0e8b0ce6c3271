// pool.hpp — lends scratch memory to threads and keeps it for the next piece of work.
#pragma once
#include <memory>
#include <mutex>
#include <vector>

namespace molmesh::par {

/// Lends a T to each working thread; makes as many as work at once.
template <class T>
class Pool {
public:
  /// use(t), on a T that no other thread has meanwhile; make() is a new std::unique_ptr<T>. Every T lives as long
  /// as the pool, use() may throw or not: others may read what it holds.
  template <class Make, class Use>
  void with(Make&& make, Use&& use) {
    const Loan loan(*this, make);
    use(*loan.t);
  }
  /// While no thread works.
  const std::vector<std::unique_ptr<T>>& all() const { return own_; }

private:
  struct Loan {
    template <class Make>
    Loan(Pool& from, Make&& make) : pool(from), t(from.borrow(make)) {}
    Loan(const Loan&) = delete;
    ~Loan() {
      const std::lock_guard<std::mutex> lock(pool.guard_);
      pool.free_.push_back(t);
    }
    Pool& pool;
    T* t;
  };
  template <class Make>
  T* borrow(Make&& make) {
    {
      const std::lock_guard<std::mutex> lock(guard_);
      if (!free_.empty()) {
        T* const t = free_.back();
        free_.pop_back();
        return t;
      }
    }
    std::unique_ptr<T> t = make();
    const std::lock_guard<std::mutex> lock(guard_);
    own_.push_back(std::move(t));
    free_.reserve(own_.size()); // giving back allocates nothing
    return own_.back().get();
  }

  std::mutex guard_;
  std::vector<std::unique_ptr<T>> own_;
  std::vector<T*> free_;
};

} // namespace molmesh::par
