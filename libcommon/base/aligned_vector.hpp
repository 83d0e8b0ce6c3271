// aligned_vector.hpp — arrays of numbers for the kernels. They begin on a cache line, so that no vector of 16 lies
// on two.
#pragma once
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace molmesh {

template <class T>
struct LineAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = LineAllocator<U>;
  };
  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, line); }

private:
  static constexpr std::align_val_t line{64};
};

template <class T>
using Numbers = std::vector<T, LineAllocator<T>>;
using Floats = Numbers<float>;

} // namespace molmesh
