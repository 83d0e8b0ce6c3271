// copy_bytes.cpp — copies a mebibyte at a time on each thread.
#include "cuda/par/copy_bytes.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cstring>

namespace molmesh::cuda {

void copy_bytes(const std::byte* from, int64_t bytes, std::byte* to, int threads) {
  constexpr int64_t piece = int64_t{1} << 20;
  par::for_n((bytes + piece - 1) / piece, threads, 1, [&](int64_t i) {
    std::memcpy(to + i * piece, from + i * piece, static_cast<size_t>(std::min(piece, bytes - i * piece)));
  });
}

} // namespace molmesh::cuda
