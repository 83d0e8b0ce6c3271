// large_array.hpp — a vector for arrays of many megabytes: resizing does not touch them.
// Pages of the ordinary size: asking for large ones fills 512 MB in 0.06 s where the system has them at hand, but
// in 1.4 s where a virtual machine has to fetch them from its host; ordinary ones took 0.25 s always.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <malloc.h>
#include <memory>
#include <new>
#include <sys/mman.h>
#include <utility>
#include <vector>

namespace molmesh {

/// For types whose constructor would only write what is overwritten before it is read.
template <class T>
inline constexpr bool leave_untouched = false;

template <class T>
struct LargeAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = LargeAllocator<U>;
  };
  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}
  /// resize(n) leaves new elements uninitialized.
  template <class U>
  void construct(U* p) {
    if constexpr (!leave_untouched<U>)
      ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Arguments>
  void construct(U* p, Arguments&&... arguments) {
    ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
  }
};

template <class T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

/// Asks the system for the pages that [begin, begin + bytes), all of it the caller's, lies in at once, where it can:
/// from a quarter cheaper to 17 times (virtual machines that leave to their host for every fault) than one by one
/// as they are touched.
inline void prepare_pages(void* begin, std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
  constexpr std::uintptr_t page = 4096;
  const auto first = reinterpret_cast<std::uintptr_t>(begin) & ~(page - 1),
             end = (reinterpret_cast<std::uintptr_t>(begin) + bytes + page - 1) & ~(page - 1);
  if (bytes > page)
    madvise(reinterpret_cast<void*>(first), end - first, MADV_POPULATE_WRITE);
#else
  static_cast<void>(begin), static_cast<void>(bytes);
#endif
}

/// For a program whose passes give back large arrays and ask for new ones: glibc keeps what is freed instead of
/// returning it, so that its pages need not be fetched and zeroed again.
inline void keep_freed_pages() {
#ifdef M_MMAP_MAX
  constexpr int pad = 64 << 20;
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TOP_PAD, pad);
#endif
}

} // namespace molmesh
