// large_array.hpp — a vector for arrays of many megabytes: resizing does not touch them.
// Pages of the ordinary size: asking for large ones fills 512 MB in 0.06 s where the system has them at hand, but
// in 1.4 s where a virtual machine has to fetch them from its host; ordinary ones took 0.25 s always.
#pragma once
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace molmesh {

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
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Arguments>
  void construct(U* p, Arguments&&... arguments) {
    ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
  }
};

template <class T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

} // namespace molmesh
