// index_table.hpp — finds the elements of a sequence by their keys, in six to twelve bytes for each of them.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh {

/// Open addressing. It keeps indices alone: whoever asks has the elements, 0, 1, 2, …
class IndexTable {
public:
  /// The element of this hash for which same(index) holds; else it is `next`, which is known from now on. next: how
  /// many elements are known. hash_of(index): of a known one.
  template <class Same, class HashOf>
  uint32_t find_or_add(uint32_t next, size_t hash, Same same, HashOf hash_of) {
    if (3 * (size_t{next} + 1) > 2 * slot_.size())
      grow(next, hash_of);
    size_t s = hash & (slot_.size() - 1);
    for (; slot_[s] != 0; s = after(s))
      if (same(slot_[s] - 1))
        return slot_[s] - 1;
    slot_[s] = next + 1;
    return next;
  }
  /// Knows nothing, and gives back what took more than a few bytes: to clear those takes as long as ever so many
  /// elements did.
  void clear() {
    if (slot_.size() > 16)
      std::vector<uint32_t>().swap(slot_);
    std::fill(slot_.begin(), slot_.end(), 0);
  }

private:
  size_t after(size_t s) const { return (s + 1) & (slot_.size() - 1); }
  template <class HashOf>
  void grow(uint32_t known, HashOf hash_of) {
    const size_t size = std::max<size_t>(2 * slot_.size(), 16);
    std::vector<uint32_t>().swap(slot_); // not two tables at once
    slot_.resize(size);
    for (uint32_t i = 0; i < known; ++i) {
      size_t s = hash_of(i) & (size - 1);
      while (slot_[s] != 0)
        s = after(s);
      slot_[s] = i + 1;
    }
  }

  std::vector<uint32_t> slot_; ///< 1 + index, 0: none; a power of two
};

} // namespace molmesh
