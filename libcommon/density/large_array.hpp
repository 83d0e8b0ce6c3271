// large_array.hpp — a vector for arrays of many megabytes: resizing does not touch them, pages are large where the
// system has large ones. Filling a fresh gigabyte costs more in page faults than in computing it.
#pragma once
#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace molmesh {

template <class T>
struct LargeAllocator {
  using value_type = T;
  static constexpr size_t page = size_t{1} << 21, large = 4 * page; // bytes

  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}
  T* allocate(size_t n) {
    const size_t bytes = n * sizeof(T);
    if (bytes < large)
      return static_cast<T*>(::operator new(bytes));
    void* const p = std::aligned_alloc(page, (bytes + page - 1) / page * page);
    if (!p)
      throw std::bad_alloc();
    return static_cast<T*>(p);
  }
  void deallocate(T* p, size_t n) {
    if (n * sizeof(T) < large)
      ::operator delete(p);
    else
      std::free(p);
  }
  /// resize(n) leaves new elements uninitialized.
  template <class U>
  void construct(U* p) {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Arguments>
  void construct(U* p, Arguments&&... arguments) {
    ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
  }
  template <class U>
  bool operator==(const LargeAllocator<U>&) const {
    return true;
  }
};

template <class T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

} // namespace molmesh
