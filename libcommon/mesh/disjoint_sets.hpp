// disjoint_sets.hpp — joins items into disjoint sets; a set is named by its first item.
#pragma once
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace molmesh {

class DisjointSets {
public:
  /// Each alone.
  explicit DisjointSets(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  void join(int32_t a, int32_t b) {
    const int32_t x = first(a), y = first(b);
    at(std::max(x, y)) = std::min(x, y);
  }
  /// Of the set that i is in.
  int32_t first(int32_t i) {
    while (at(i) != i)
      i = at(i) = at(at(i));
    return i;
  }

private:
  int32_t& at(int32_t i) { return parent_[i]; }
  std::vector<int32_t> parent_;
};

} // namespace molmesh
