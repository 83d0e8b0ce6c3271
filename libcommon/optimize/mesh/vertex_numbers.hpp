// vertex_numbers.hpp — small numbers for the vertices of a neighbourhood, in the order they are met.
#pragma once
#include "optimize/mesh/open_table.hpp"

namespace molmesh::optimize {

class VertexNumbers {
public:
  /// O(1): what was met before is forgotten.
  void clear() {
    number_.clear();
    met_.clear();
  }
  /// Those met so far, by their numbers.
  const std::vector<int32_t>& met() const { return met_; }
  bool knows(int32_t vertex) const { return number_.find(static_cast<uint32_t>(vertex)) != nullptr; }
  /// The vertex' number: met().size() of before when it is new.
  size_t operator()(int32_t vertex) {
    int32_t& number = number_[static_cast<uint32_t>(vertex)];
    if (number < 0) {
      number = static_cast<int32_t>(met_.size());
      met_.push_back(vertex);
    }
    return static_cast<size_t>(number);
  }

private:
  OpenTable number_;
  std::vector<int32_t> met_;
};

} // namespace molmesh::optimize
