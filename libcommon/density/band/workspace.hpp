// workspace.hpp — keeps the memory of a thread of the search from one brick to the next.
#pragma once
#include "density/band/active_set_simd.hpp"
#include "density/band/brick_state.hpp"
#include "density/band/search_counts.hpp"
#include "density/culling/block_atoms.hpp"
#include "density/values/block_evaluation.hpp"
#include "par/arena.hpp"
#include <type_traits>
#include <vector>

namespace molmesh::density {

/// Memory of finished bricks, for the next ones.
class Spares {
public:
  BrickPoints* sides() {
    if (!sides_.empty())
      return last_of(sides_);
    constexpr size_t size = sizeof(BrickPoints) / sizeof(float);
    static_assert(alignof(BrickPoints) <= 16 && sizeof(BrickPoints) % 16 == 0 &&
                  size <= par::Arena<float>::largest &&
                  std::is_trivially_destructible_v<BrickPoints>); // as the arena has them
    BrickPoints* const sides = new (points_.take(size)) BrickPoints;
    points_.keep(size);
    return sides;
  }
  LargeArray<BandBlock> band() { return band_.empty() ? LargeArray<BandBlock>() : last_of(band_); }
  void forget(BrickState& s) {
    if (s.sides)
      sides_.push_back(s.sides);
    if (s.band.capacity() > 0 && band_.size() < most)
      band_.push_back(std::move(s.band));
    s = BrickState{};
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
  std::vector<BrickPoints*> sides_;
  std::vector<LargeArray<BandBlock>> band_;
};

/// Slabs of a search: new, found, finished.
constexpr size_t slabs_at_work = 3;

struct Workspace {
  BlockAtoms block;
  Evaluator evaluator = {};
  alignas(64) float value[blocks_a_brick][512] = {}; ///< of the blocks of the brick at work
  BrickWords below = {}, above = {}, far_below = {}, far_above = {}, active = {};
  BrickBits rows = {};
  Sides beyond = {};
  /// Values of the band, by the turn of the search that packed them.
  std::array<par::Arena<float>, slabs_at_work - 1> values = {};
  size_t turn = 0;
  par::Arena<float>& packed() { return values[turn % values.size()]; }
  /// A new turn overwrites the values of the slab that has been given away.
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
