// give_back_memory.hpp — returns freed memory to the system where it is not needed again.
#pragma once
#include <cstddef>
#include <cstdint>
#include <sys/mman.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace molmesh {

/// keep_freed_pages() keeps freed memory for arrays that come again; those of what has been read do not.
inline void give_back_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

/// Returns the pages that lie wholly in [begin, begin + bytes), whose content is no longer needed, of an array that
/// lives on.
inline void give_back_pages(void* begin, std::size_t bytes) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE)),
             at = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (at + page - 1) / page * page, end = (at + bytes) / page * page;
  if (first < end)
    madvise(reinterpret_cast<void*>(first), end - first, MADV_DONTNEED);
}

} // namespace molmesh
