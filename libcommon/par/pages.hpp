// pages.hpp — memory of large arrays asked for on all threads.
#pragma once
#include "density/large_array.hpp"
#include "par/par.hpp"
#include <cstddef>

namespace molmesh::par {

/// Room for n elements, which will be written soon, and for `more`, which may be.
template <class Vector>
void reserve_pages(Vector& v, size_t n, size_t more, int threads) {
  constexpr int64_t chunk = int64_t{1} << 22; // bytes
  v.reserve(n + more);
  auto* const begin = reinterpret_cast<std::byte*>(v.data() + v.size());
  const auto bytes = static_cast<int64_t>((n - v.size()) * sizeof(*v.data()));
  for_n((bytes + chunk - 1) / chunk, threads, 1, [&](int64_t c) {
    prepare_pages(begin + c * chunk, static_cast<size_t>(std::min(chunk, bytes - c * chunk)));
  });
}

} // namespace molmesh::par
