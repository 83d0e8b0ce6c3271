// workspace.hpp — what a thread of the search keeps from one node to the next, so that nothing is allocated twice.
#pragma once
#include "density/band_kernel.hpp"
#include "density/evaluate.hpp"
#include "density/large_array.hpp"
#include "density/node_state.hpp"
#include "density/search_counts.hpp"
#include "density/selection.hpp"
#include <memory>
#include <mutex>
#include <type_traits>
#include <vector>

namespace molmesh::density {

/// Floats handed out piece by piece; they stay where they are.
class Arena {
public:
  /// A piece of at most `most` ≤ 2^15 floats; keep() says how many of them stay.
  float* take(size_t most) {
    if (chunk_.empty() || used_ + most > size) {
      chunk_.emplace_back(size);
      used_ = ready_ = 0;
    }
    if (used_ + most > ready_) {
      prepare_pages(chunk_.back().data() + ready_, at_once * sizeof(float));
      ready_ += at_once;
    }
    return chunk_.back().data() + used_;
  }
  void keep(size_t n) { used_ += n; }
  std::vector<LargeArray<float>> release() { return std::move(chunk_); }

private:
  static constexpr size_t size = size_t{1} << 21, at_once = size_t{1} << 15; // 8 MiB, 128 KiB
  std::vector<LargeArray<float>> chunk_;
  size_t used_ = 0, ready_ = 0; ///< of the last chunk
};

/// What nodes that nobody needs any more leave to the next ones.
class Spares {
public:
  NodePoints* sides() {
    if (!sides_.empty())
      return last_of(sides_);
    constexpr size_t size = sizeof(NodePoints) / sizeof(float);
    static_assert(alignof(NodePoints) <= 16 && sizeof(NodePoints) % 16 == 0 && size <= size_t{1} << 15 &&
                  std::is_trivially_destructible_v<NodePoints>); // as the arena has them
    NodePoints* const sides = new (points_.take(size)) NodePoints;
    points_.keep(size);
    return sides;
  }
  std::vector<BandBlock> band() { return band_.empty() ? std::vector<BandBlock>() : last_of(band_); }
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
  Arena points_;
  std::vector<NodePoints*> sides_;
  std::vector<std::vector<BandBlock>> band_;
};

struct Workspace {
  Selection selection;
  Evaluator evaluator = {};
  alignas(64) float value[blocks_a_node][512] = {}; ///< of the blocks of the node at work
  NodeWords below = {}, above = {}, far_below = {}, far_above = {}, active = {};
  NodeBits rows = {};
  Sides beyond = {};
  Arena packed = {}; ///< of the band
  Spares spares = {};
  SearchCounts counts = {};
  int64_t points = 0; ///< of the grid, evaluated
};

/// Hands workspaces to whoever works; as many as ever worked at once.
class Workspaces {
public:
  template <class Make>
  std::unique_ptr<Workspace> borrow(Make&& make) {
    const std::lock_guard<std::mutex> lock(guard_);
    if (free_.empty())
      return make();
    std::unique_ptr<Workspace> w = std::move(free_.back());
    free_.pop_back();
    return w;
  }
  void give_back(std::unique_ptr<Workspace> w) {
    const std::lock_guard<std::mutex> lock(guard_);
    free_.push_back(std::move(w));
  }
  /// When nobody works.
  std::vector<std::unique_ptr<Workspace>>& all() { return free_; }

private:
  std::mutex guard_;
  std::vector<std::unique_ptr<Workspace>> free_;
};

} // namespace molmesh::density
