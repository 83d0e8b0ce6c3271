// atomic_updates.hpp — order-independent atomic updates: flag, minimum. Host and device.
#pragma once
#include "base/hd.hpp"
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace molmesh::par {

/// Of a place that others may change meanwhile.
template <class T>
MOLMESH_HD inline T seen(const T& place) {
#ifdef __CUDA_ARCH__
  return *const_cast<const volatile T*>(&place);
#else
  return std::atomic_ref<T>(const_cast<T&>(place)).load(std::memory_order_relaxed);
#endif
}
template <class T>
MOLMESH_HD inline void put(T& place, T value) {
#ifdef __CUDA_ARCH__
  *const_cast<volatile T*>(&place) = value;
#else
  std::atomic_ref<T>(place).store(value, std::memory_order_relaxed);
#endif
}

/// A flag, only ever set, and read when the pass is over.
MOLMESH_HD inline void raise(uint8_t& flag) {
  put(flag, uint8_t{1});
}

/// Lowers the place to `value` where that is less; returns what was there. The least of all stays. T: 32 or 64
/// bits.
template <class T>
MOLMESH_HD inline T lower(T& place, T value) {
  static_assert(std::is_same_v<T, uint32_t> || std::is_same_v<T, uint64_t>);
#ifdef __CUDA_ARCH__
  if constexpr (sizeof(T) == 8)
    return atomicMin(reinterpret_cast<unsigned long long*>(&place), static_cast<unsigned long long>(value));
  else
    return atomicMin(&place, value);
#else
  const std::atomic_ref<T> at(place);
  T was = at.load(std::memory_order_relaxed);
  while (value < was && !at.compare_exchange_weak(was, value, std::memory_order_relaxed)) {
  }
  return was;
#endif
}

} // namespace molmesh::par
