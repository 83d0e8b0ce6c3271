// helpers.cpp — keeps idle threads waiting until work is shared.
#include "par/helpers.hpp"
#include <algorithm>

namespace molmesh::par {
namespace {

/// f() at the end of the scope, however it is left.
template <class F>
struct AtEnd {
  F f;
  explicit AtEnd(F g) : f(g) {}
  ~AtEnd() { f(); }
  AtEnd(const AtEnd&) = delete;
  AtEnd& operator=(const AtEnd&) = delete;
};

} // namespace

Helpers::Busy::Busy(Helpers& helpers) : helpers_(helpers) {
  const std::lock_guard<std::mutex> lock(helpers_.guard_);
  ++helpers_.busy_;
}

Helpers::Busy::~Busy() {
  {
    const std::lock_guard<std::mutex> lock(helpers_.guard_);
    --helpers_.busy_;
  }
  helpers_.change_.notify_all();
}

void Helpers::close(const Shared& s) {
  open_.erase(std::remove(open_.begin(), open_.end(), &s), open_.end());
}

void Helpers::share(const std::function<void()>& own, const std::function<void()>& theirs) {
  Shared mine{theirs};
  {
    const std::lock_guard<std::mutex> lock(guard_);
    open_.push_back(&mine);
  }
  change_.notify_all();
  const AtEnd all_out([&] {
    std::unique_lock<std::mutex> lock(guard_);
    close(mine);
    change_.wait(lock, [&] { return mine.inside == 0; });
  });
  own();
}

void Helpers::help() {
  std::unique_lock<std::mutex> lock(guard_);
  ++idle_;
  const AtEnd no_longer([&] { --idle_; });
  for (;;) {
    change_.wait(lock, [&] { return busy_ == 0 || !open_.empty(); });
    if (open_.empty())
      return;
    Shared& s = **std::min_element(open_.begin(), open_.end(),
                                   [](const Shared* a, const Shared* b) { return a->inside < b->inside; });
    ++s.inside;
    --idle_;
    lock.unlock();
    const AtEnd out([&] {
      lock.lock();
      ++idle_;
      --s.inside;
      close(s);
      change_.notify_all();
    });
    s.task();
  }
}

} // namespace molmesh::par
