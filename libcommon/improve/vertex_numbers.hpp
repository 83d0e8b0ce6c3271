// vertex_numbers.hpp — small numbers for the vertices of a neighbourhood, in the order they are met.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh::improve {

class VertexNumbers {
public:
  /// O(1): what was met before is forgotten.
  void clear() {
    ++clock_;
    met_.clear();
  }
  /// Those met so far, by their numbers.
  const std::vector<int32_t>& met() const { return met_; }
  /// The vertex' number: met().size() of before when it is new.
  size_t operator()(int32_t vertex) {
    if (2 * (met_.size() + 1) > slot_.size())
      grow();
    Slot& s = place(vertex);
    if (s.clock != clock_) {
      s = {vertex, static_cast<uint32_t>(met_.size()), clock_};
      met_.push_back(vertex);
    }
    return s.number;
  }

private:
  struct Slot {
    int32_t vertex = -1;
    uint32_t number = 0;
    uint64_t clock = 0;
  };
  /// Where the vertex is or would go.
  Slot& place(int32_t vertex) {
    const size_t mask = slot_.size() - 1;
    size_t i = (uint64_t(uint32_t(vertex)) * 0x9E3779B97F4A7C15u >> 40) & mask;
    while (slot_[i].clock == clock_ && slot_[i].vertex != vertex)
      i = (i + 1) & mask;
    return slot_[i];
  }
  void grow() {
    slot_.assign(slot_.empty() ? 128 : 4 * slot_.size(), {});
    for (size_t k = 0; k < met_.size(); ++k)
      place(met_[k]) = {met_[k], static_cast<uint32_t>(k), clock_};
  }
  std::vector<Slot> slot_; ///< a power of two, at most half full
  std::vector<int32_t> met_;
  uint64_t clock_ = 1;
};

} // namespace molmesh::improve
