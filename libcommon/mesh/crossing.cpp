// crossing.cpp — a tree of boxes over the triangles along a space-filling curve.
#include "mesh/crossing.hpp"
#include "geom/intersect.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh {
namespace {

struct Box {
  Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  void add(Vec3d l, Vec3d h) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], l[k]);
      high[k] = std::max(high[k], h[k]);
    }
  }
  bool meets(const Box& b) const {
    for (int k = 0; k < 3; ++k)
      if (low[k] > b.high[k] || high[k] < b.low[k])
        return false;
    return true;
  }
};

/// 16 bits of each coordinate, interleaved.
uint64_t morton(Vec3d x, const Box& all) {
  uint64_t code = 0;
  for (int k = 0; k < 3; ++k) {
    const double extent = all.high[k] - all.low[k];
    const auto cell = static_cast<uint64_t>(extent > 0 ? (x[k] - all.low[k]) / extent * 65535 : 0);
    for (int bit = 0; bit < 16; ++bit)
      code |= (cell >> bit & 1) << (3 * bit + k);
  }
  return code;
}

/// Level 0 has a box for each triangle in the order of the curve; each further level a box for each eight below.
class Tree {
public:
  Tree(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads) : level_(1) {
    const auto n = static_cast<int64_t>(tri.size());
    std::vector<Box> box(tri.size());
    par::for_n(n, threads, [&](int64_t t) {
      for (int32_t v : tri[static_cast<size_t>(t)])
        box[static_cast<size_t>(t)].add(point[static_cast<size_t>(v)], point[static_cast<size_t>(v)]);
    });
    Box all;
    for (const Box& b : box)
      all.add(b.low, b.high);
    std::vector<std::pair<uint64_t, int32_t>> order(tri.size());
    par::for_n(n, threads, [&](int64_t t) {
      const Box& b = box[static_cast<size_t>(t)];
      order[static_cast<size_t>(t)] = {morton(0.5 * (b.low + b.high), all), static_cast<int32_t>(t)};
    });
    par::sort(order, threads);
    for (const auto& [code, t] : order) {
      triangle_.push_back(t);
      level_[0].push_back(box[static_cast<size_t>(t)]);
    }
    while (level_.back().size() > 1) {
      std::vector<Box> up((level_.back().size() + 7) / 8);
      for (size_t i = 0; i < level_.back().size(); ++i)
        up[i / 8].add(level_.back()[i].low, level_.back()[i].high);
      level_.push_back(std::move(up));
    }
  }

  int32_t triangle(size_t place) const { return triangle_[place]; }

  /// visit(place) for the places after `place` whose boxes meet its box.
  template <class Visit>
  void after(size_t place, Visit visit) const {
    descend(level_.size() - 1, 0, place, visit);
  }

private:
  template <class Visit>
  void descend(size_t level, size_t i, size_t place, Visit& visit) const {
    if ((i + 1) << (3 * level) <= place + 1 || !level_[level][i].meets(level_[0][place]))
      return;
    if (level == 0) {
      visit(i);
      return;
    }
    for (size_t child = 8 * i; child < std::min(8 * i + 8, level_[level - 1].size()); ++child)
      descend(level - 1, child, place, visit);
  }

  std::vector<std::vector<Box>> level_;
  std::vector<int32_t> triangle_;
};

} // namespace

Crossings find_crossings(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads) {
  const Tree tree(point, tri, threads);
  const auto of = [&](int64_t place) {
    Crossings c;
    const int32_t s = tree.triangle(static_cast<size_t>(place));
    tree.after(static_cast<size_t>(place), [&](size_t other) {
      const int32_t t = tree.triangle(other);
      if (!triangles_cross(point, tri[static_cast<size_t>(s)], tri[static_cast<size_t>(t)]))
        return;
      const std::array<int32_t, 2> pair{std::min(s, t), std::max(s, t)};
      c.first = c.pairs++ == 0 ? pair : std::min(c.first, pair);
    });
    return c;
  };
  return par::reduce(
      static_cast<int64_t>(tri.size()), threads, Crossings{}, of,
      [](const Crossings& a, const Crossings& b) {
        const auto first = a.pairs == 0 ? b.first : b.pairs == 0 ? a.first : std::min(a.first, b.first);
        return Crossings{a.pairs + b.pairs, first};
      },
      256);
}

} // namespace molmesh
