// raise.hpp — a flag that several threads may set at once. Host and device.
#pragma once
#include "geom/hd.hpp"
#include <atomic>
#include <cstdint>

namespace molmesh::contour::detail {

/// Only ever set, never read before the pass is over: the result does not know the order.
HD inline void raise(uint8_t& flag) {
#ifdef __CUDA_ARCH__
  flag = 1;
#else
  std::atomic_ref<uint8_t>(flag).store(1, std::memory_order_relaxed);
#endif
}

} // namespace molmesh::contour::detail
