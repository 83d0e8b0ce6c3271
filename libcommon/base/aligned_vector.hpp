// aligned_vector.hpp — a vector that begins on a cache line, so that no SIMD vector of 16 floats lies on two.
#pragma once
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace molmesh {

template <class T>
struct CacheLineAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = CacheLineAllocator<U>;
  };
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, line); }

private:
  static constexpr std::align_val_t line{64};
};

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;
using AlignedFloats = AlignedVector<float>;

} // namespace molmesh
