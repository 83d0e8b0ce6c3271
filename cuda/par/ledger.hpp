// ledger.hpp — counts the bytes that arrays take of the device's memory and, beyond it, of the host's.
#pragma once
#include "base/error.hpp"
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

namespace molmesh::cuda {

/// An array did not fit: what asked for it may try with less at a time.
struct OutOfRoom : Error {
  OutOfRoom(int64_t asked, int64_t room)
      : Error(Status::failed, "not enough memory on the device: " + std::to_string((asked >> 20) + 1) +
                                  " MiB more were needed, " + std::to_string(std::max<int64_t>(room, 0) >> 20) +
                                  " MiB are free") {}
};

struct Bytes {
  int64_t own = std::numeric_limits<int64_t>::max(); ///< of the device's memory
  int64_t paged = 0;                                 ///< of the host's beside it, which the device pages
};

class Ledger {
public:
  explicit Ledger(Bytes most) : most_(most) {}

  /// That follows will take so much at once: where it is more than there is, a quarter is left to pages, and large
  /// arrays are paged from the first, so that the small ones, which are used most, are not.
  void plan(int64_t bytes) {
    if (most_.paged <= 0 || is_tight_ || bytes <= room())
      return;
    is_tight_ = true;
    most_.own = most_.own / 4 * 3;
  }
  int64_t room() const { return most_.own - used_.own; }
  /// Whether an array of that size is to be paged. Throws OutOfRoom where neither memory has room.
  bool is_paged(int64_t bytes) const {
    if (bytes <= (is_tight_ ? room() / 4 : room()))
      return false;
    if (has_pages(bytes))
      return true;
    if (bytes <= room())
      return false;
    throw OutOfRoom(bytes, room() + std::max<int64_t>(most_.paged - used_.paged, 0));
  }
  bool has_pages(int64_t bytes) const { return bytes <= most_.paged - used_.paged; }
  void add(int64_t bytes, bool paged) {
    int64_t& used = paged ? used_.paged : used_.own;
    int64_t& peak = paged ? peak_.paged : peak_.own;
    used += bytes;
    peak = std::max(peak, used);
  }
  void subtract(int64_t bytes, bool paged) { (paged ? used_.paged : used_.own) -= bytes; }
  Bytes most_used() const { return peak_; }

private:
  Bytes most_, used_{0, 0}, peak_{0, 0};
  bool is_tight_ = false;
};

} // namespace molmesh::cuda
