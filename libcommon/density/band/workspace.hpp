// workspace.hpp — what a thread of the search keeps from one node to the next, so that nothing is allocated twice.
#pragma once
#include "density/band/band_simd.hpp"
#include "density/band/node_state.hpp"
#include "density/band/search_counts.hpp"
#include "density/culling/selection.hpp"
#include "density/values/evaluate.hpp"
#include "par/arena.hpp"
#include <type_traits>
#include <vector>

namespace molmesh::density {

/// What nodes that nobody needs any more leave to the next ones.
class Spares {
public:
  NodePoints* sides() {
    if (!sides_.empty())
      return last_of(sides_);
    constexpr size_t size = sizeof(NodePoints) / sizeof(float);
    static_assert(alignof(NodePoints) <= 16 && sizeof(NodePoints) % 16 == 0 && size <= par::Arena<float>::largest &&
                  std::is_trivially_destructible_v<NodePoints>); // as the arena has them
    NodePoints* const sides = new (points_.take(size)) NodePoints;
    points_.keep(size);
    return sides;
  }
  LargeArray<BandBlock> band() { return band_.empty() ? LargeArray<BandBlock>() : last_of(band_); }
  void forget(NodeState& s) {
    if (s.sides)
      sides_.push_back(s.sides);
    if (s.band.capacity() > 0 && band_.size() < most)
      band_.push_back(std::move(s.band));
    s = NodeState{};
  }

private:
  static constexpr size_t most = 1024;
  template <class T>
  static T last_of(std::vector<T>& v) {
    T t = std::move(v.back());
    v.pop_back();
    return t;
  }
  par::Arena<float> points_;
  std::vector<NodePoints*> sides_;
  std::vector<LargeArray<BandBlock>> band_;
};

/// Slabs of a search: new, found, finished.
constexpr size_t slabs_at_work = 3;

struct Workspace {
  Selection selection;
  Evaluator evaluator = {};
  alignas(64) float value[blocks_a_node][512] = {}; ///< of the blocks of the node at work
  NodeWords below = {}, above = {}, far_below = {}, far_above = {}, active = {};
  NodeBits rows = {};
  Sides beyond = {};
  /// Values of the band, by the turn of the search that packed them.
  std::array<par::Arena<float>, slabs_at_work - 1> values = {};
  size_t turn = 0;
  par::Arena<float>& packed() { return values[turn % values.size()]; }
  /// A new turn takes the room of the one whose slab has been given away.
  void begin(size_t new_turn) {
    if (turn == new_turn)
      return;
    turn = new_turn;
    packed().restart();
  }
  RowHints near_found = {}, near_finished = {};
  Spares spares = {};
  SearchCounts counts = {};
  int64_t points = 0; ///< of the grid, evaluated
};

} // namespace molmesh::density
