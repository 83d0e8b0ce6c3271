// box_tree.hpp — the triangles whose boxes meet one: a tree of boxes over triangles in the order that they come in.
#pragma once
#include "improve/sheets.hpp"
#include "par/par.hpp"
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh::improve {

/// Of triangles that stay as they are. What is near in their order should be near in space.
class BoxTree {
public:
  /// triangle(i): of n of them.
  template <class Triangle>
  BoxTree(size_t n, Triangle&& triangle, int threads = 1) {
    const auto add_level = [&](size_t boxes, auto&& box) {
      std::vector<EightBoxes> level((boxes + 7) / 8);
      par::for_n(static_cast<int64_t>(level.size()), threads, 64, [&](int64_t e) {
        for (size_t i = 8 * size_t(e); i < boxes && i < 8 * size_t(e) + 8; ++i)
          level[size_t(e)].set(i % 8, static_cast<int32_t>(i), box(i));
      });
      level_.push_back(std::move(level));
    };
    add_level(n, triangle);
    while (level_.back().size() > 1) {
      const size_t below = level_.size() - 1;
      add_level(level_[below].size(), [&](size_t i) { return level_[below][i].bounds(); });
    }
  }
  /// True as soon as f(index of a triangle) is, over all whose boxes t's meets.
  template <class F>
  bool any(const SheetTriangle& t, F&& f) const {
    return !level_.back().empty() && descend(level_.size() - 1, 0, t, f);
  }

private:
  template <class F>
  bool descend(size_t level, size_t e, const SheetTriangle& t, F& f) const {
    const EightBoxes& eight = level_[level][e];
    for (uint32_t met = eight.met(t); met; met &= met - 1) {
      const auto below = size_t(eight.triangle[size_t(std::countr_zero(met))]);
      if (level == 0 ? f(below) : descend(level - 1, below, t, f))
        return true;
    }
    return false;
  }

  std::vector<std::vector<EightBoxes>> level_; ///< the first of triangles, each further one of eights below
};

} // namespace molmesh::improve
