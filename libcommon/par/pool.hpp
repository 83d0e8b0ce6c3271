// pool.hpp — what a thread needs for its work, kept from one piece of work to the next.
#pragma once
#include <memory>
#include <mutex>
#include <vector>

namespace molmesh::par {

/// Lends a T to whoever works; as many as ever worked at once.
template <class T>
class Pool {
public:
  /// use(t), on a T that nobody else has meanwhile; make() is a new std::unique_ptr<T>.
  template <class Make, class Use>
  void with(Make&& make, Use&& use) {
    std::unique_ptr<T> t = borrow(make);
    use(*t);
    const std::lock_guard<std::mutex> lock(guard_);
    free_.push_back(std::move(t));
  }
  /// When nobody works.
  std::vector<std::unique_ptr<T>>& all() { return free_; }

private:
  template <class Make>
  std::unique_ptr<T> borrow(Make&& make) {
    {
      const std::lock_guard<std::mutex> lock(guard_);
      if (!free_.empty()) {
        std::unique_ptr<T> t = std::move(free_.back());
        free_.pop_back();
        return t;
      }
    }
    return make();
  }

  std::mutex guard_;
  std::vector<std::unique_ptr<T>> free_;
};

} // namespace molmesh::par
