// backend.hpp — what an algorithm asks of the machine it runs on, and how its time is told.
//
// An algorithm of this folder is a template over a Backend: par/host.hpp (threads of the host, in every build and
// in the tests) or par/device.cuh (one GPU). Both offer, for trivially copyable T:
//   Array<T> array<T>(n)               n uninitialized elements: data(), size(); freed in order with the work
//   Array<T> filled<T>(n, value)
//   Array<T> upload(pointer, n)
//   void download(array, n, pointer)   returns when the elements are there
//   Pending<T> fetch(Array<T>)         starts a download beside the work that follows; get() waits for it
//   for_n(name, n, item, work)         item(i) for i in [0, n), each call independent of the others
//   for_teams(name, n, item, work)     item(i, team, shared): Item::team_size threads work on i together
//   T scan(name, pointer, n)           count[i] → sum of count[0..i), in place; slot n, one more, gets the total
//   sort_pairs(name, keys, values, n)  ascending keys, unsigned integers; equal keys keep their order
//   int64_t room()                     bytes that may still be taken
// An item is a struct of plain views with a const operator() marked HD, in a header that compiles without CUDA.
#pragma once
#include "error.hpp"
#include "geom/hd.hpp"
#include "par/work.hpp"
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace molmesh::cuda {

using par::Work;

/// All launches of one name.
struct KernelTime {
  std::string name;
  int64_t launches = 0;
  double seconds = 0;
  Work work;
};

/// What a run on the device was, for the run report.
struct DeviceReport {
  std::string device;
  int64_t most_bytes = 0; ///< of device memory at once
  std::vector<KernelTime> kernels;
  std::string note{}; ///< what the device did not do, and why; may be empty
};

/// One thread of a team of `size`. The host's teams are one thread; a GPU's are a warp.
struct Solo {
  static constexpr int size = 1;
  HD int rank() const { return 0; }
  HD void sync() const {}
};

/// An array did not fit: what asked for it may try with less at a time.
struct OutOfRoom : Error {
  OutOfRoom(int64_t asked, int64_t room)
      : Error(Status::failed, "not enough memory on the device: " + std::to_string((asked >> 20) + 1) +
                                  " MiB more were needed, " + std::to_string(room >> 20) + " MiB are free") {}
};

/// n elements of a backend's memory. Owner: void* take(bytes), give_back(pointer, bytes) noexcept.
template <class Owner, class T>
class OwnedArray {
public:
  OwnedArray() = default;
  OwnedArray(Owner& owner, int64_t n) : owner_(&owner), n_(n), data_(static_cast<T*>(owner.take(bytes()))) {}
  OwnedArray(OwnedArray&& o) noexcept { swap(o); }
  OwnedArray& operator=(OwnedArray&& o) noexcept {
    OwnedArray(std::move(o)).swap(*this);
    return *this;
  }
  ~OwnedArray() {
    if (owner_)
      owner_->give_back(data_, bytes());
  }
  T* data() const { return data_; }
  int64_t size() const { return n_; }

private:
  int64_t bytes() const { return n_ * static_cast<int64_t>(sizeof(T)); }
  void swap(OwnedArray& o) noexcept {
    std::swap(owner_, o.owner_);
    std::swap(n_, o.n_);
    std::swap(data_, o.data_);
  }
  Owner* owner_ = nullptr;
  int64_t n_ = 0;
  T* data_ = nullptr;
};

/// Adds to the entry of that name, made when new.
inline void add_time(std::vector<KernelTime>& times, const char* name, double seconds, const Work& work) {
  for (KernelTime& t : times)
    if (t.name == name) {
      ++t.launches;
      t.seconds += seconds;
      t.work.bytes += work.bytes;
      t.work.multiply_adds += work.multiply_adds;
      t.work.in_double = t.work.in_double || work.in_double;
      return;
    }
  times.push_back({name, 1, seconds, work});
}

} // namespace molmesh::cuda
