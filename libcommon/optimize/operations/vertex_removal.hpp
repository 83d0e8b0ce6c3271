// vertex_removal.hpp — a vertex goes to the neighbour where its elements stay best, as far as sizes allow.
#pragma once
#include "optimize/operations/operations.hpp"
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace molmesh::optimize {

/// Removes vertices of a region by contraction where no new edge is much longer than the sizes at its ends.
class VertexRemoval {
public:
  /// size [vertices]: Å, as target_sizes() has it. accept: Aim::size.
  VertexRemoval(Region& r, const Acceptance& accept, const std::vector<float>& size)
      : r_(r), accept_(accept), size_(size) {}
  /// Whether a has gone; where not, nothing has changed.
  bool operator()(int32_t a);

private:
  bool find_neighbors(int32_t a);
  bool lengths_allow(int32_t a, int32_t b) const;
  bool surface_allows(int32_t b) const;
  float worst_at(int32_t a, int32_t b, float above) const;
  bool contract(int32_t a, int32_t b);

  Region& r_;
  const Acceptance& accept_;
  const std::vector<float>& size_;
  std::vector<int32_t> star_, near_;                 ///< elements at the vertex; its neighbours
  std::vector<int32_t> labelled_;                    ///< of these, those that share a labelled face with it
  std::vector<std::pair<int32_t, uint8_t>> surface_; ///< and a curved one, of that label
  std::vector<std::pair<float, int32_t>> places_;    ///< where it may go; the best first
};

} // namespace molmesh::optimize
