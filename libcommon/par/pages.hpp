// pages.hpp — asks for the memory of large arrays on all threads.
#pragma once
#include "base/large_array.hpp"
#include "par/par.hpp"
#include <cstddef>

namespace molmesh::par {

/// Of n elements: room to grow a little in place takes no memory before it is written.
inline size_t a_few(size_t n) {
  return n / 64;
}

/// Room for n elements, which will be written soon, and for `more`, which may be.
template <class Vector>
void reserve_pages(Vector& v, size_t n, size_t more, int threads) {
  v.reserve(n + more);
  if (n > v.size())
    prepare_pages(v.data() + v.size(), (n - v.size()) * sizeof(*v.data()), threads);
}

/// n elements, all to be overwritten; in memory at hand where there is enough of it.
template <class Vector>
void resize_pages(Vector& v, size_t n, int threads) {
  if (v.capacity() < n)
    v = {};
  reserve_pages(v, n, 0, threads);
  v.resize(n);
}

} // namespace molmesh::par
