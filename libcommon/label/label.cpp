// label.cpp — evaluates the tree of sums at places, tile by tile of places near each other.
#include "label/label.hpp"
#include "base/error.hpp"
#include "density/culling/kd_tree.hpp"
#include "geom/morton.hpp"
#include "label/near_sums.hpp"
#include "molecule/bodies.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace molmesh::label {
namespace {

using density::Box;
using density::Field;
using density::KdTree;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Places near each other, in Morton order. Clusters near a block of tiles are found at once.
struct Tiles {
  std::vector<std::pair<uint64_t, int64_t>> item; ///< key, place
  std::vector<int64_t> begin;                     ///< [tiles + 1]
  std::vector<int64_t> block;                     ///< [blocks + 1] first tile
};

/// Squares of longer distances are no doubles.
bool within_reach(const Vec3d& p) {
  return norm2(p) < infinity;
}

Tiles make_tiles(const std::vector<Vec3d>& place, int threads) {
  constexpr int64_t most = 4 * lanes, most_in_block = 16 * most; // places
  constexpr double widest = 16, widest_block = 32;               // Å: else places have too little in common
  constexpr int axis_bits = 21;
  Tiles t;
  Vec3d lo{infinity, infinity, infinity}, hi = -1 * lo;
  for (size_t i = 0; i < place.size(); ++i) {
    if (!within_reach(place[i]))
      continue;
    t.item.push_back({0, static_cast<int64_t>(i)});
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], place[i][a]);
      hi[a] = std::max(hi[a], place[i][a]);
    }
  }
  double edge = 1e-3; // Å, of the smallest cube
  for (int a = 0; a < 3; ++a)
    edge = std::max(edge, (hi[a] - lo[a]) / ((1 << axis_bits) - 1));
  par::for_n(static_cast<int64_t>(t.item.size()), threads, [&](int64_t i) {
    const Vec3d v = (place[t.item[i].second] - lo) / edge;
    t.item[i].first =
        morton(Vec3i{static_cast<int32_t>(v.x), static_cast<int32_t>(v.y), static_cast<int32_t>(v.z)});
  });
  par::sort(t.item, threads);
  const auto divide = [&](auto&& self, int64_t begin, int64_t end, int level, bool in_block) -> void {
    if (begin == end)
      return;
    if (!in_block && (level == 0 || (end - begin <= most_in_block && edge * (1 << level) <= widest_block))) {
      t.block.push_back(static_cast<int64_t>(t.begin.size()));
      in_block = true;
    }
    if (level == 0 || (end - begin <= most && edge * (1 << level) <= widest)) {
      t.begin.push_back(begin);
      return;
    }
    for (uint64_t octant = 0; octant < 8; ++octant) {
      const int64_t stop =
          std::partition_point(t.item.begin() + begin, t.item.begin() + end,
                               [&](const auto& i) { return (i.first >> 3 * (level - 1) & 7) <= octant; }) -
          t.item.begin();
      self(self, begin, stop, level - 1, in_block);
      begin = stop;
    }
  };
  divide(divide, 0, static_cast<int64_t>(t.item.size()), axis_bits, false);
  t.block.push_back(static_cast<int64_t>(t.begin.size()));
  t.begin.push_back(static_cast<int64_t>(t.item.size()));
  return t;
}

/// The field of a hierarchy, to be asked at places.
struct Evaluator {
  Field f;
  double enough;   ///< ln: where G is less, what was left out may be felt
  double left_out; ///< as in NearSums
  KdTree tree{f};

  Evaluator(const Hierarchy& h, const Options& o, double left)
      : f(density::make_field(h, o.decay, 1e-8 * o.isovalue)), enough(std::log(1e7 * f.far_error)), left_out(left) {
  }

  /// take(i, sums, lane) at place i, from any thread, the last call counts; not where G = 0 in logarithms too.
  template <class Take>
  void for_places(const std::vector<Vec3d>& place, int threads, Take take) const {
    const Tiles tiles = make_tiles(place, threads);
    par::for_n(static_cast<int64_t>(tiles.block.size()) - 1, threads, 1, [&](int64_t b) {
      const int64_t first = tiles.block[b], last = tiles.block[b + 1];
      const Box box = box_of(place, tiles, first, last);
      std::vector<int32_t> cluster = tree.near(box);
      double least = enough;
      NearSums sums(f, left_out);
      const auto gather_all = [&] {
        cluster.resize(static_cast<size_t>(f.clusters()));
        std::iota(cluster.begin(), cluster.end(), 0);
        least = -infinity;
        sums.gather(box, cluster);
      };
      if (cluster.empty())
        gather_all();
      else
        sums.gather(box, cluster);
      for (int64_t t = first; t < last; ++t)
        if (!for_tile(place, tiles, t, least, sums, take)) {
          gather_all();
          for_tile(place, tiles, t, least, sums, take);
        }
    });
  }

private:
  /// Of the places of these tiles.
  static Box box_of(const std::vector<Vec3d>& place, const Tiles& tiles, int64_t first, int64_t last) {
    Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (int64_t i = tiles.begin[first]; i < tiles.begin[last]; ++i)
      for (int a = 0; a < 3; ++a) {
        const double v = place[tiles.item[i].second][a];
        box.lo[a] = std::min(box.lo[a], v);
        box.hi[a] = std::max(box.hi[a], v);
      }
    return box;
  }
  /// False where ln G is below `least`.
  template <class Take>
  bool for_tile(const std::vector<Vec3d>& place, const Tiles& tiles, int64_t t, double least, NearSums& sums,
                Take& take) const {
    sums.choose(box_of(place, tiles, t, t + 1));
    std::array<Vec3d, lanes> at;
    for (int64_t i = tiles.begin[t]; i < tiles.begin[t + 1]; i += lanes) {
      const int n = static_cast<int>(std::min<int64_t>(lanes, tiles.begin[t + 1] - i));
      for (int k = 0; k < n; ++k)
        at[static_cast<size_t>(k)] = place[tiles.item[i + k].second];
      sums.evaluate(at.data(), n);
      for (int k = 0; k < n; ++k)
        if (!(sums.ln_field(k) >= least))
          return false;
      for (int k = 0; k < n; ++k)
        take(static_cast<size_t>(tiles.item[i + k].second), sums, k);
    }
    return true;
  }
};

} // namespace

Labels find_labels(const Hierarchy& h, const std::vector<Vec3d>& place, const Options& options) {
  if (h.atom.size() > static_cast<size_t>(std::numeric_limits<int32_t>::max()))
    fail_input("over 2^31 - 1 atoms, expected fewer");
  if (!all_have_bodies(h)) {
    const Bodies bodies = bodies_of(h);
    Labels labels = find_labels(bodies.hierarchy, place, options);
    for (size_t l = 0; l < labels.index.size(); ++l)
      for (int32_t& index : labels.index[l])
        index = index < 0 ? index : static_cast<int32_t>(bodies.index[l][index]);
    return labels;
  }
  Labels labels;
  for (const Level& l : h.level)
    labels.level.push_back(l.name);
  labels.level.push_back("atom");
  const size_t levels = labels.level.size();
  labels.index.assign(levels, std::vector<int32_t>(place.size()));
  labels.share.assign(levels, std::vector<double>(place.size()));
  labels.ln_field.resize(place.size());
  if (place.empty())
    return labels;

  for (std::vector<int32_t>& index : labels.index)
    std::fill(index.begin(), index.end(), -1);
  std::fill(labels.ln_field.begin(), labels.ln_field.end(), -infinity);
  Evaluator(h, options, -16).for_places(place, options.threads, [&](size_t p, const NearSums& sums, int lane) {
    labels.ln_field[p] = sums.ln_field(lane);
    sums.descend(lane, [&](int level, int64_t index, double share) {
      const size_t l = levels - 2 - static_cast<size_t>(level); // atoms: levels - 1
      if (l >= levels)
        return; // the field's one group of a hierarchy without levels
      labels.index[l][p] = static_cast<int32_t>(index);
      labels.share[l][p] = share;
    });
  });
  return labels;
}

struct ShareFinder::Impl {
  Evaluator field;
  size_t level;               ///< as in the field
  std::vector<int64_t> group; ///< [group of the field] that group's index; empty: the same

  Impl(const Hierarchy& h, size_t l, const Options& o)
      : field(h, o, Shares::none - 6), level(h.level.size() - 1 - l) {}
  Impl(const Bodies& b, size_t l, const Options& o) : Impl(b.hierarchy, l, o) { group = b.index[l]; }
};

ShareFinder::ShareFinder(const Hierarchy& h, size_t level, const Options& options)
    : options_(options),
      impl_(all_have_bodies(h) ? new Impl(h, level, options) : new Impl(bodies_of(h), level, options)) {}
ShareFinder::~ShareFinder() = default;

std::vector<Shares> ShareFinder::at(const std::vector<Vec3d>& place) const {
  std::vector<Shares> all(place.size());
  for (Shares& s : all)
    s.ln_field = -infinity;
  impl_->field.for_places(place, options_.threads, [&](size_t p, NearSums& sums, int lane) {
    Shares& s = all[p] = {};
    s.ln_field = sums.ln_field(lane);
    sums.shares(lane, impl_->level, [&](int64_t g, double share) {
      const int64_t group = impl_->group.empty() ? g : impl_->group[g];
      for (size_t k = 0; k < Shares::most; ++k)
        if (share > s.ln[k]) {
          for (size_t i = Shares::most - 1; i > k; --i)
            s.ln[i] = s.ln[i - 1], s.group[i] = s.group[i - 1];
          s.ln[k] = share;
          s.group[k] = static_cast<int32_t>(group);
          return;
        }
    });
  });
  return all;
}

} // namespace molmesh::label
