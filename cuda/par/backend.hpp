// backend.hpp — what an algorithm asks of the machine it runs on, and how its time is measured.
//
// An algorithm of this folder is a template over a Backend: par/host.hpp (threads of the host, in every build and
// in the tests) or par/device.cuh (one GPU). Both are a par::Launcher (par/launcher.hpp), whose arrays are freed in
// order with the work, and offer besides:
//   Pending<T> fetch(pointer, n)       starts a download beside the work that follows; get() waits for it, and
//                                      until then the array stays
//   Pending<T> fetch(pointer, n, true) of what was there then: by one other thread, beside what follows
//   void settle()                      returns when all that was started is over
//   for_teams(name, n, item, work)     item(i, team, shared): Team::size threads work on i together
//   int64_t room()                     bytes of the device's memory that may still be taken
//   void plan(bytes)                   what follows takes so many at once: says what is to be paged (Ledger)
// Where the device's memory does not suffice, array() throws OutOfRoom, or, as the backend was made, takes memory
// of the host that the device pages: slower, and else the same.
#pragma once
#include "base/hd.hpp"
#include "cuda/par/ledger.hpp"
#include "par/launcher.hpp"
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace molmesh::cuda {

using par::Work;

/// All launches of one name.
struct KernelTime {
  std::string name;
  int64_t launches = 0, items = 0;
  double seconds = 0;
  Work work;
};

/// What a run on the device was, for the run report.
struct DeviceReport {
  std::string device;
  Bytes most_used{0, 0}; ///< at once
  std::vector<KernelTime> kernels;
  std::string note{}; ///< what was not as usual; may be empty
};

/// One thread of a team of `size`. The host's teams are one thread; a GPU's are a warp.
struct Solo {
  static constexpr int size = 1;
  MOLMESH_HD int rank() const { return 0; }
  MOLMESH_HD void sync() const {}
  /// Of what all threads have, to all of them: the least, and the sum.
  template <class T>
  MOLMESH_HD T least(T mine) const {
    return mine;
  }
  template <class T>
  MOLMESH_HD T sum(T mine) const {
    return mine;
  }
  /// How many threads before this one say yes; all: how many do.
  MOLMESH_HD int before(bool mine, int& all) const {
    all = mine;
    return 0;
  }
};

/// Memory of a backend.
struct Taken {
  void* data = nullptr;
  bool paged = false;
};

/// n elements of a backend's memory. Owner: Taken take(bytes), give_back(Taken, bytes) noexcept.
template <class Owner, class T>
class OwnedArray {
public:
  OwnedArray() = default;
  OwnedArray(Owner& owner, int64_t n) : owner_(&owner), n_(n), taken_(owner.take(bytes())) {}
  OwnedArray(OwnedArray&& o) noexcept { swap(o); }
  OwnedArray& operator=(OwnedArray&& o) noexcept {
    OwnedArray(std::move(o)).swap(*this);
    return *this;
  }
  ~OwnedArray() {
    if (owner_)
      owner_->give_back(taken_, bytes());
  }
  T* data() const { return static_cast<T*>(taken_.data); }
  int64_t size() const { return n_; }

private:
  int64_t bytes() const { return n_ * static_cast<int64_t>(sizeof(T)); }
  void swap(OwnedArray& o) noexcept {
    std::swap(owner_, o.owner_);
    std::swap(n_, o.n_);
    std::swap(taken_, o.taken_);
  }
  Owner* owner_ = nullptr;
  int64_t n_ = 0;
  Taken taken_;
};

/// Adds to the entry of that name, made when new.
inline void add_time(std::vector<KernelTime>& times, const char* name, int64_t items, double seconds,
                     const Work& work) {
  for (KernelTime& t : times)
    if (t.name == name) {
      ++t.launches;
      t.items += items;
      t.seconds += seconds;
      t.work.bytes += work.bytes;
      t.work.multiply_adds += work.multiply_adds;
      t.work.in_double = t.work.in_double || work.in_double;
      return;
    }
  times.push_back({name, 1, items, seconds, work});
}

/// Of all that the backend has done.
template <class Backend>
DeviceReport report_of(Backend& backend, std::string device) {
  DeviceReport r{std::move(device), backend.most_used(), backend.times()};
  if (r.most_used.paged > 0)
    r.note =
        std::to_string((r.most_used.paged >> 20) + 1) + " MiB did not fit the device: paged from the host's memory";
  return r;
}

} // namespace molmesh::cuda
