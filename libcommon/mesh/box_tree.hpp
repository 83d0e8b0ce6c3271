// box_tree.hpp — finds the boxes that meet a box: a tree of eights over boxes in their given order.
#pragma once
#include "geom/boxes.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh {

/// Of boxes that stay as they are. What is near in their order should be near in space.
class BoxTree {
public:
  /// box(i): of n of them.
  template <class Box>
  BoxTree(size_t n, Box&& box, int threads = 1) {
    const auto add_level = [&](size_t boxes, auto&& box_of) {
      std::vector<EightBoxes> level((boxes + 7) / 8);
      par::for_n(static_cast<int64_t>(level.size()), threads, 64, [&](int64_t e) {
        for (size_t i = 8 * size_t(e); i < boxes && i < 8 * size_t(e) + 8; ++i)
          level[e].set(i % 8, static_cast<int32_t>(i), box_of(i));
      });
      level_.push_back(std::move(level));
    };
    add_level(n, box);
    while (level_.back().size() > 1) {
      const size_t below = level_.size() - 1;
      add_level(level_[below].size(), [&](size_t i) { return level_[below][i].bounds(); });
    }
  }
  /// True as soon as f(i) is, over all i from `first` on whose boxes meet that one, in order.
  template <class F>
  bool any(const Boxf& box, F&& f, size_t first = 0) const {
    return !level_.back().empty() && descend(level_.size() - 1, 0, box, first, f);
  }

  /// Visits the boxes that come within the distance of p whose square is `best`, the nearest of eight first; f(i)
  /// returns what `best` is from then on.
  template <class F>
  void near(Vec3d p, double best, F&& f) const {
    if (!level_.back().empty())
      approach(level_.size() - 1, 0, p, best, f);
  }

private:
  template <class F>
  void approach(size_t level, size_t e, Vec3d p, double& best, F& f) const {
    const EightBoxes& eight = level_[level][e];
    struct Child {
      double distance2;
      int32_t id;
    } child[8];
    int n = 0;
    for (size_t i = 0; i < 8 && eight.id[i] >= 0; ++i) {
      double distance2 = 0;
      for (size_t k = 0; k < 3; ++k) {
        const double x = p[int(k)], off = std::max({eight.low[k][i] - x, x - eight.high[k][i], 0.});
        distance2 += off * off;
      }
      if (distance2 > best)
        continue;
      int at = n++;
      for (; at > 0 && child[at - 1].distance2 > distance2; --at)
        child[at] = child[at - 1];
      child[at] = {distance2, eight.id[i]};
    }
    for (int i = 0; i < n && child[i].distance2 <= best; ++i) {
      if (level == 0)
        best = f(size_t(child[i].id));
      else
        approach(level - 1, size_t(child[i].id), p, best, f);
    }
  }
  template <class F>
  bool descend(size_t level, size_t e, const Boxf& box, size_t first, F& f) const {
    const EightBoxes& eight = level_[level][e];
    const size_t from = first >> (3 * level);
    for (uint32_t met = eight.met(box); met; met &= met - 1) {
      const auto below = size_t(eight.id[std::countr_zero(met)]);
      if (below >= from && (level == 0 ? f(below) : descend(level - 1, below, box, first, f)))
        return true;
    }
    return false;
  }

  std::vector<std::vector<EightBoxes>> level_; ///< the first of boxes, each further one of eights below
};

} // namespace molmesh
