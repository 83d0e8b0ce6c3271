// arena.hpp — hands out memory piece by piece; pieces stay where they are.
#pragma once
#include "base/large_array.hpp"
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace molmesh::par {

/// One thread's. T: numbers or bytes.
template <class T>
class Arena {
public:
  static constexpr size_t largest = (size_t{1} << 17) / sizeof(T);
  /// A piece of at most `most` ≤ largest elements; keep() says how many of them stay.
  T* take(size_t most) {
    if (chunk_.empty() || used_ + most > size_of(at_)) {
      at_ += chunk_.empty() ? 0 : 1;
      if (at_ == chunk_.size())
        chunk_.push_back({LargeArray<T>(size_of(at_))});
      used_ = 0;
    }
    Chunk& c = chunk_[at_];
    if (used_ + most > c.ready) {
      prepare_pages(c.room.data() + c.ready, largest * sizeof(T));
      c.ready += largest;
    }
    return c.room.data() + used_;
  }
  void keep(size_t n) { used_ += n; }
  /// Forgets all pieces; their pages are handed out again.
  void restart() { at_ = used_ = 0; }
  /// The memory of all pieces: they live as long as it does.
  std::vector<LargeArray<T>> release() {
    std::vector<LargeArray<T>> all;
    for (Chunk& c : chunk_)
      all.push_back(std::move(c.room));
    chunk_.clear();
    restart();
    return all;
  }

private:
  /// Small at first: a large page is not for a few pieces alone.
  static size_t size_of(size_t chunk) { return largest << std::min<size_t>(chunk, 6); }
  struct Chunk {
    LargeArray<T> room;
    size_t ready = 0; ///< elements whose pages are there
  };
  std::vector<Chunk> chunk_;
  size_t at_ = 0, used_ = 0; ///< the chunk in use, and of it
};

} // namespace molmesh::par
