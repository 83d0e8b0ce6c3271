// search.cpp — from the whole grid to nodes of 4³ blocks, to blocks; then the band cells between blocks.
#include "density/search.hpp"
#include "density/band.hpp"
#include "density/cluster_tree.hpp"
#include "density/evaluate.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>

namespace molmesh::density {
namespace {

constexpr int32_t node_blocks = 4; ///< blocks along an edge of the nodes that one thread works through

/// A cube of blocks with the clusters that can matter in it.
struct Node {
  Vec3i corner; ///< in blocks
  int64_t begin, end;
};
struct NodeList {
  std::vector<Node> node;
  std::vector<int32_t> cluster;
  std::span<const int32_t> clusters(const Node& n) const {
    return std::span(cluster).subspan(static_cast<size_t>(n.begin), static_cast<size_t>(n.end - n.begin));
  }
};

/// Slots for the values of blocks, handed out one by one; they stay where they are until all are given back.
class Arena {
public:
  float* take() {
    if (used_ == blocks_a_chunk * chunk_.size())
      chunk_.emplace_back(512 * blocks_a_chunk);
    float* const slot = &chunk_[used_ / blocks_a_chunk][512 * (used_ % blocks_a_chunk)];
    ++used_;
    return slot;
  }
  void give_back_last() { --used_; }
  void give_back_all() { used_ = 0; }

private:
  static constexpr size_t blocks_a_chunk = 256; // 512 KiB
  std::vector<LargeArray<float>> chunk_;
  size_t used_ = 0;
};

/// What a thread works with, one node after the other.
struct Workspace {
  Selection selection;
  Evaluator evaluator;
  Arena arena[2]; ///< for slabs of even and odd number
};

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

  void forget_values(int bank) {
    for (const std::unique_ptr<Workspace>& w : free_)
      w->arena[bank].give_back_all();
  }

private:
  std::mutex guard_;
  std::vector<std::unique_ptr<Workspace>> free_;
};

/// What one node found.
struct Found {
  std::vector<KnownBlock> known;
  std::vector<Vec3i> corner; ///< of known
  std::vector<Vec3i> inside;
  SearchCounts counts;
  int64_t points = 0;
};

/// The blocks of a slab of nodes, and what they point to.
struct Layer {
  KnownBlocks blocks;
  std::vector<std::vector<Found>> found;
};

class Search {
public:
  Search(const Field& f, const GridFrame& frame, const SearchOptions& o)
      : f_(f), frame_(frame), o_(o), budget_(budget_for(o)), arithmetic_(arithmetic_for(f, o.tolerance)),
        lower_(float_at_least(o.band_lower)), upper_(-float_at_least(-o.band_upper)) {}
  Band run(SearchCounts& counts);

private:
  /// The smallest float >= v: comparing floats with it is comparing them with v.
  static float float_at_least(double v) {
    const auto f = static_cast<float>(v);
    return f >= v ? f : std::nextafter(f, std::numeric_limits<float>::infinity());
  }
  Box box_of(Vec3i corner, int32_t blocks) const;
  bool in_grid(Vec3i corner) const;
  void descend();
  void ask_tree();
  Layer find_slab(std::span<const Node> nodes);
  void work_through(const Node& node, Found& found, Workspace& w) const;
  /// discard: forget a block that lies wholly on one side of the band.
  void evaluate(Vec3i corner, bool classify, bool discard, Found& found, Workspace& w) const;
  void add_missing(Layer& window, Slab slab);
  void collect(std::vector<Found> found, Layer& layer);
  std::unique_ptr<Workspace> workspace() {
    return workspaces_.borrow([this] {
      return std::make_unique<Workspace>(
          Workspace{Selection(f_, budget_, o_.band_lower, o_.band_upper, arithmetic_), {}, {{}, {}}});
    });
  }

  const Field& f_;
  const GridFrame& frame_;
  const SearchOptions& o_;
  const Budget budget_;
  const Arithmetic arithmetic_;
  const float lower_, upper_;
  NodeList nodes_; ///< ascending
  Workspaces workspaces_;
  SearchCounts counts_;
  int64_t analyzed_ = 0;
  int bank_ = 0; ///< of arenas, for the slab at work
  std::atomic<int64_t> done_{0};
};

/// Of the points of a cube of blocks, from block `corner`.
Box Search::box_of(Vec3i corner, int32_t blocks) const {
  const Vec3i first = 8 * corner;
  return {frame_.position(first), frame_.position(first + Vec3i{1, 1, 1} * (8 * blocks - 1))};
}

bool Search::in_grid(Vec3i corner) const {
  for (int a = 0; a < 3; ++a)
    if (8 * int64_t{corner[a]} >= int64_t{frame_.lower[a]} + frame_.points[a])
      return false;
  return true;
}

/// Halves cubes of blocks, from one that holds the grid, and keeps for each the clusters within their cutoff.
void Search::descend() {
  int32_t blocks = node_blocks;
  const Vec3i first = {frame_.lower.x >> 3, frame_.lower.y >> 3, frame_.lower.z >> 3};
  for (int a = 0; a < 3; ++a)
    while (8 * (int64_t{first[a]} + blocks) < int64_t{frame_.lower[a]} + frame_.points[a])
      blocks *= 2;
  NodeList parents;
  parents.cluster.resize(static_cast<size_t>(f_.clusters()));
  std::iota(parents.cluster.begin(), parents.cluster.end(), 0);
  parents.node.push_back({first, 0, f_.clusters()});
  while (blocks > node_blocks) {
    blocks /= 2;
    const auto n = static_cast<int64_t>(parents.node.size()) * 8;
    std::vector<std::vector<int32_t>> lists(static_cast<size_t>(n));
    const auto corner = [&](int64_t i) {
      const auto c = static_cast<int32_t>(i & 7);
      return parents.node[static_cast<size_t>(i >> 3)].corner + blocks * Vec3i{c >> 2, c >> 1 & 1, c & 1};
    };
    par::for_n(n, o_.threads, 1, [&](int64_t i) {
      if (!in_grid(corner(i)))
        return;
      const Box box = box_of(corner(i), blocks);
      for (const int32_t c : parents.clusters(parents.node[static_cast<size_t>(i >> 3)]))
        if (distance2(box, f_.box[static_cast<size_t>(c)]) < f_.cutoff2[static_cast<size_t>(c)])
          lists[static_cast<size_t>(i)].push_back(c);
    });
    NodeList children;
    for (int64_t i = 0; i < n; ++i) {
      const std::vector<int32_t>& list = lists[static_cast<size_t>(i)];
      if (list.empty() && !(o_.full && in_grid(corner(i))))
        continue;
      const auto begin = static_cast<int64_t>(children.cluster.size());
      children.cluster.insert(children.cluster.end(), list.begin(), list.end());
      children.node.push_back({corner(i), begin, static_cast<int64_t>(children.cluster.size())});
    }
    parents = std::move(children);
  }
  nodes_ = std::move(parents);
  std::sort(nodes_.node.begin(), nodes_.node.end(),
            [](const Node& a, const Node& b) { return a.corner < b.corner; });
}

/// Every node of the grid asks a kd-tree; the clusters it gets are those that descend() finds.
void Search::ask_tree() {
  const ClusterTree tree(f_);
  Vec3i n;
  const Vec3i first{frame_.lower.x >> 3, frame_.lower.y >> 3, frame_.lower.z >> 3};
  for (int a = 0; a < 3; ++a)
    n[a] = (((frame_.lower[a] + frame_.points[a] + 7) >> 3) - first[a] + node_blocks - 1) / node_blocks;
  std::vector<std::vector<int32_t>> lists(static_cast<size_t>(n.z));
  for (int32_t x = 0; x < n.x; ++x)
    for (int32_t y = 0; y < n.y; ++y) {
      const auto corner = [&](int64_t z) { return first + node_blocks * Vec3i{x, y, static_cast<int32_t>(z)}; };
      par::for_n(n.z, o_.threads, 1,
                 [&](int64_t z) { lists[static_cast<size_t>(z)] = tree.near(box_of(corner(z), node_blocks)); });
      for (int64_t z = 0; z < n.z; ++z) {
        const std::vector<int32_t>& list = lists[static_cast<size_t>(z)];
        if (list.empty() && !o_.full)
          continue;
        const auto begin = static_cast<int64_t>(nodes_.cluster.size());
        nodes_.cluster.insert(nodes_.cluster.end(), list.begin(), list.end());
        nodes_.node.push_back({corner(z), begin, static_cast<int64_t>(nodes_.cluster.size())});
      }
    }
}

/// Points of the block that belong to the grid.
int64_t points_in_grid(const GridFrame& frame, Vec3i corner) {
  int64_t n = 1;
  for (int a = 0; a < 3; ++a)
    n *= std::min(corner[a] + 8, frame.lower[a] + frame.points[a]) - std::max(corner[a], frame.lower[a]);
  return n;
}

void Search::evaluate(Vec3i corner, bool classify, bool discard, Found& found, Workspace& w) const {
  const Box box = box_of(corner, 1);
  const Vec3d middle = 0.5 * (box.lo + box.hi);
  ++found.counts.blocks_visited;
  w.selection.select(middle, 0.5 * (box.hi - box.lo), classify);
  if (w.selection.side == Side::outside)
    return;
  if (w.selection.side == Side::inside)
    return found.inside.push_back(8 * corner);
  float* const value = w.arena[bank_].take();
  w.evaluator.evaluate(f_, w.selection, middle, frame_.spacing, value);
  KnownBlock block{value, {}, {}};
  classify_points(value, lower_, upper_, block.below.data(), block.above.data());
  ++found.counts.blocks_evaluated;
  found.counts.group_visits += static_cast<int64_t>(w.selection.unit.size());
  found.counts.atom_visits += w.selection.atoms;
  found.points += points_in_grid(frame_, 8 * corner);
  if (discard) {
    const auto all = [](uint64_t word) { return word == ~uint64_t{0}; };
    const bool above = std::all_of(block.above.begin(), block.above.end(), all);
    if (above || std::all_of(block.below.begin(), block.below.end(), all)) {
      w.arena[bank_].give_back_last();
      if (above)
        found.inside.push_back(8 * corner);
      return;
    }
  }
  found.known.push_back(block);
  found.corner.push_back(8 * corner);
}

void Search::work_through(const Node& node, Found& found, Workspace& w) const {
  const Box all = box_of(node.corner, node_blocks);
  w.selection.enter(0.5 * (all.lo + all.hi), nodes_.clusters(node));
  for (int32_t octant = 0; octant < 8; ++octant) {
    const Vec3i part = node.corner + 2 * Vec3i{octant >> 2, octant >> 1 & 1, octant & 1};
    const Box box = box_of(part, 2);
    if (!in_grid(part) || (!w.selection.narrow(0.5 * (box.lo + box.hi), 0.5 * (box.hi - box.lo)) && !o_.full))
      continue;
    for (int32_t i = 0; i < 8; ++i)
      if (const Vec3i corner = part + Vec3i{i >> 2, i >> 1 & 1, i & 1}; in_grid(corner))
        evaluate(corner, !o_.full, o_.full, found, w);
  }
}

/// Sorts what was found into the blocks of a slab.
void Search::collect(std::vector<Found> found, Layer& layer) {
  std::vector<int64_t> known(found.size()), inside(found.size());
  for (size_t n = 0; n < found.size(); ++n) {
    const Found& f = found[n];
    known[n] = static_cast<int64_t>(f.known.size());
    inside[n] = static_cast<int64_t>(f.inside.size());
    counts_.blocks_visited += f.counts.blocks_visited;
    counts_.blocks_evaluated += f.counts.blocks_evaluated;
    counts_.group_visits += f.counts.group_visits;
    counts_.atom_visits += f.counts.atom_visits;
    analyzed_ += f.points;
  }
  KnownBlocks& b = layer.blocks;
  const auto before = static_cast<int64_t>(b.known.size()), before_inside = static_cast<int64_t>(b.inside.size());
  b.known.resize(static_cast<size_t>(before + par::exclusive_scan(known)));
  b.inside.resize(static_cast<size_t>(before_inside + par::exclusive_scan(inside)));
  par::for_n(static_cast<int64_t>(found.size()), o_.threads, 16, [&](int64_t i) {
    const Found& f = found[static_cast<size_t>(i)];
    KnownCorner* to = b.known.data() + before + known[static_cast<size_t>(i)];
    for (size_t k = 0; k < f.known.size(); ++k)
      *to++ = {f.corner[k], &f.known[k]};
    std::copy(f.inside.begin(), f.inside.end(), b.inside.begin() + before_inside + inside[static_cast<size_t>(i)]);
  });
  par::sort(b.known, o_.threads, [](const KnownCorner& a, const KnownCorner& c) { return a.corner < c.corner; });
  par::sort(b.inside, o_.threads);
  layer.found.push_back(std::move(found));
}

Layer Search::find_slab(std::span<const Node> nodes) {
  std::vector<Found> found(nodes.size());
  par::for_n(static_cast<int64_t>(nodes.size()), o_.threads, 1, [&](int64_t i) {
    std::unique_ptr<Workspace> w = workspace();
    work_through(nodes[static_cast<size_t>(i)], found[static_cast<size_t>(i)], *w);
    workspaces_.give_back(std::move(w));
    if (o_.progress)
      o_.progress(++done_, static_cast<int64_t>(nodes_.node.size()));
  });
  Layer layer;
  collect(std::move(found), layer);
  return layer;
}

/// Evaluates the blocks that bounds left out next to a band cell: their points are on its corners, and lie where
/// the bounds say.
void Search::add_missing(Layer& window, Slab slab) {
  const std::vector<Vec3i> missing = blocks_missing_from_band(window.blocks, slab, frame_, o_.threads);
  if (missing.empty())
    return;
  struct Task {
    Vec3i node, block; ///< in blocks
  };
  const Vec3i first{frame_.lower.x >> 3, frame_.lower.y >> 3, frame_.lower.z >> 3};
  std::vector<Task> task;
  for (const Vec3i& m : missing) {
    const Vec3i block{m.x >> 3, m.y >> 3, m.z >> 3}, in = block - first;
    constexpr int32_t mask = ~(node_blocks - 1);
    task.push_back({first + Vec3i{in.x & mask, in.y & mask, in.z & mask}, block});
  }
  par::sort(task, o_.threads,
            [](const Task& a, const Task& b) { return a.node == b.node ? a.block < b.block : a.node < b.node; });
  std::vector<size_t> begin;
  for (size_t i = 0; i < task.size(); ++i)
    if (i == 0 || !(task[i].node == task[i - 1].node))
      begin.push_back(i);
  begin.push_back(task.size());
  std::vector<Found> found(begin.size() - 1);
  par::for_n(static_cast<int64_t>(found.size()), o_.threads, 1, [&](int64_t n) {
    const auto t = static_cast<size_t>(n);
    const Vec3i node = task[begin[t]].node;
    const auto at = std::lower_bound(nodes_.node.begin(), nodes_.node.end(), node,
                                     [](const Node& a, Vec3i c) { return a.corner < c; });
    const bool there = at != nodes_.node.end() && at->corner == node;
    std::unique_ptr<Workspace> w = workspace();
    const Box box = box_of(node, node_blocks);
    const Vec3d middle = 0.5 * (box.lo + box.hi);
    w->selection.enter(middle, there ? nodes_.clusters(*at) : std::span<const int32_t>());
    w->selection.narrow(middle, 0.5 * (box.hi - box.lo));
    for (size_t i = begin[t]; i < begin[t + 1]; ++i)
      evaluate(task[i].block, false, false, found[t], *w);
    workspaces_.give_back(std::move(w));
  });
  std::erase_if(window.blocks.inside,
                [&](Vec3i c) { return std::binary_search(missing.begin(), missing.end(), c); });
  collect(std::move(found), window);
}

/// Slab by slab of nodes along x, so that only two slabs hold the values of all their points.
Band Search::run(SearchCounts& counts) {
  Band band;
  band.frame = frame_;
  band.info.isovalue = o_.isovalue;
  band.info.decay = f_.decay;
  band.info.band_lower = o_.band_lower;
  band.info.band_upper = o_.band_upper;
  band.info.tolerance = o_.tolerance;
  band.info.inside_value = static_cast<float>(std::max(2 * o_.isovalue, o_.band_upper));
  band.info.atoms = f_.atoms();
  o_.atoms == AtomSearch::kdtree ? ask_tree() : descend();
  Layer before, current; // `before` without values
  const std::span<const Node> nodes(nodes_.node);
  const int32_t first = frame_.lower.x >> 3, end = (frame_.lower.x + frame_.points.x + 7) >> 3;
  const auto slab_at = [](int32_t x) { return Slab{8 * x, 8 * (x + node_blocks)}; };
  for (int32_t x = first; x < end + node_blocks; x += node_blocks) {
    const auto at = [&](int32_t corner_x) {
      return std::partition_point(nodes.begin(), nodes.end(), [=](const Node& n) { return n.corner.x < corner_x; });
    };
    bank_ = (x - first) / node_blocks & 1;
    Layer next = find_slab({at(x), at(x + node_blocks)});
    if (x > first) {
      const Slab slab = slab_at(x - node_blocks);
      Layer window = std::move(before);
      window.blocks.append(current.blocks);
      window.blocks.append(next.blocks);
      add_missing(window, slab);
      append_slab(window.blocks, slab, band, o_.threads);
      workspaces_.forget_values(bank_ ^ 1);
    }
    before = std::move(current);
    current = std::move(next);
  }
  band.info.analyzed_points = o_.full ? int64_t{frame_.points.x} * frame_.points.y * frame_.points.z : analyzed_;
  counts = counts_;
  counts.active_points = band.active_points;
  return band;
}

} // namespace

Budget budget_for(const SearchOptions& o) {
  Budget b(o.tolerance);
  if (o.atoms == AtomSearch::all)
    b.far = b.block = b.within = 0;
  return b;
}

Band find_band(const Field& f, const GridFrame& frame, const SearchOptions& options, SearchCounts& counts) {
  return Search(f, frame, options).run(counts);
}

bool wall_cuts_surface(const Band& band) {
  const Vec3i lo = band.frame.lower, last = lo + band.frame.points - Vec3i{1, 1, 1};
  const auto cut = [&](Vec3i corner, auto inside) {
    for (int s = 0; s < 512; ++s) {
      const Vec3i p = corner + Vec3i{s >> 6, s >> 3 & 7, s & 7};
      const bool wall =
          p.x == lo.x || p.y == lo.y || p.z == lo.z || p.x == last.x || p.y == last.y || p.z == last.z;
      if (wall && inside(s))
        return true;
    }
    return false;
  };
  for (const BandBlock& b : band.block) {
    float value[512];
    const float* packed = b.value;
    for (size_t s = 0; s < 512; ++s) {
      const bool active = b.active[s >> 6] >> (s & 63) & 1, above = b.above[s >> 6] >> (s & 63) & 1;
      value[s] = active ? *packed++ : above ? static_cast<float>(band.info.inside_value) : 0.0f;
    }
    if (cut(b.corner, [&](int s) { return value[s] > band.info.isovalue; }))
      return true;
  }
  return std::any_of(band.inside.begin(), band.inside.end(),
                     [&](Vec3i c) { return cut(c, [](int) { return true; }); });
}

} // namespace molmesh::density
