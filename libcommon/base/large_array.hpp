// large_array.hpp — a vector for arrays of many megabytes, whose resizing does not touch them.
// Its pages are large ones where the system grants them: they are filled several times as fast, unless a virtual
// machine's host has to fetch them, and walks over scattered elements miss fewer translations
// (docs/experiments.md).
#pragma once
#include "base/array.hpp"
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <malloc.h>
#include <memory>
#include <new>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace molmesh {

/// For types whose constructor would only write what is overwritten before it is read.
template <class T>
inline constexpr bool leave_untouched = false;

/// For the pages of an array, from a size on that is worth it and before they are touched; for all that the heap
/// has grown by where it is in the heap, since what comes next will be there.
inline void ask_for_large_pages(void* array, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
  static std::atomic<std::uintptr_t> asked_up_to{0};
  if (bytes < page / 16)
    return;
  auto begin = reinterpret_cast<std::uintptr_t>(array), end = begin + bytes;
  if (const auto heap = reinterpret_cast<std::uintptr_t>(sbrk(0)); end <= heap) {
    const std::uintptr_t before = asked_up_to.exchange(heap);
    if (before >= heap) // by another thread, which may have seen it later
      return;
    begin = before == 0 ? begin : before;
    end = heap;
  }
  begin &= ~(page - 1);
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE); // or ordinary ones, as it may be
#else
  static_cast<void>(array), static_cast<void>(bytes);
#endif
}

template <class T>
struct LargeAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = LargeAllocator<U>;
  };
  T* allocate(std::size_t n) {
    T* const p = std::allocator<T>::allocate(n);
    ask_for_large_pages(p, n * sizeof(T));
    return p;
  }
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
using LargeArray = Array<T, LargeAllocator<T>>;

/// Asks the system for the pages that [begin, begin + bytes), all of it the caller's, lies in at once, where it
/// can: from a quarter cheaper to 17 times (virtual machines that leave to their host for every fault) than one by
/// one as they are touched.
inline void prepare_pages(void* begin, std::size_t bytes) {
  ask_for_large_pages(begin, bytes);
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
  LargeArray<char>(size_t{1} << 20); // the heap's first pages are large ones, too
#endif
}

} // namespace molmesh
