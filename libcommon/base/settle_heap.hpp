// settle_heap.hpp — how a program's memory begins, so that a run takes as much as any other of the same input.
#pragma once
#include "base/large_array.hpp"
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <malloc.h>
#include <sys/mman.h>

namespace molmesh {

/// Before memory of any size is taken; keeps freed pages. What is taken from now on begins where a large page does,
/// wherever the system has put the heap: else a run fills a few more or fewer of them than another one. The first
/// pages are ordinary ones: small runs take what they touch, not up to a large page for each few bytes.
inline void settle_heap() {
#ifdef M_MMAP_MAX
  constexpr std::size_t page = std::size_t{2} << 20, ordinary = 2 * page;
  mallopt(M_MMAP_MAX, 0);
  void* const end = std::malloc(page); // larger than anything freed so far: at the heap's end
  const auto at = reinterpret_cast<std::uintptr_t>(end);
  std::free(end);
  static void* up_to_page = nullptr; // never touched
  up_to_page = std::malloc(page - at % page);
  static_cast<void>(up_to_page);
  keep_freed_pages();
#ifdef MADV_NOHUGEPAGE
  madvise(reinterpret_cast<void*>(at - at % page + page), ordinary, MADV_NOHUGEPAGE);
#endif
#endif
}

} // namespace molmesh
