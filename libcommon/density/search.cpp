// search.cpp — from the whole grid to nodes of 4³ blocks, to blocks; then the band cells between blocks.
#include "density/search.hpp"
#include "density/band.hpp"
#include "density/evaluate.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <atomic>
#include <cmath>
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

/// What one node found.
struct Found {
  std::vector<Vec3i> corner;
  std::vector<float> value;
  std::vector<Vec3i> inside;
  SearchCounts counts;
  int64_t points = 0;
};

class Search {
public:
  Search(const Field& f, const GridFrame& frame, const SearchOptions& o)
      : f_(f), frame_(frame), o_(o), budget_(o.tolerance), arithmetic_(arithmetic_for(f, o.tolerance)) {}
  BlockGrid run(SearchCounts& counts);

private:
  Box box_of(Vec3i corner, int32_t blocks) const;
  bool in_grid(Vec3i corner) const;
  void descend();
  void work_through(const Node& node, Found& found, Selection& selection, Evaluator& evaluator) const;
  /// classify: leave out what bounds place. discard: forget a block that lies wholly on one side of the band.
  void evaluate(Vec3i corner, std::span<const int32_t> clusters, bool classify, bool discard, Found& found,
                Selection& selection, Evaluator& evaluator) const;
  void collect(std::vector<Found>& found, BlockGrid& grid, SearchCounts& counts) const;

  const Field& f_;
  const GridFrame& frame_;
  const SearchOptions& o_;
  const Budget budget_;
  const Arithmetic arithmetic_;
  NodeList nodes_; ///< ascending
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

/// Points of the block that belong to the grid.
int64_t points_in_grid(const GridFrame& frame, Vec3i corner) {
  int64_t n = 1;
  for (int a = 0; a < 3; ++a)
    n *= std::min(corner[a] + 8, frame.lower[a] + frame.points[a]) - std::max(corner[a], frame.lower[a]);
  return n;
}

void Search::evaluate(Vec3i corner, std::span<const int32_t> clusters, bool classify, bool discard, Found& found,
                      Selection& selection, Evaluator& evaluator) const {
  const Box box = box_of(corner, 1);
  const Vec3d middle = 0.5 * (box.lo + box.hi);
  ++found.counts.blocks_visited;
  selection.select(f_, middle, 0.5 * (box.hi - box.lo), clusters, budget_, classify, o_.band_lower, o_.band_upper);
  if (selection.side == Side::outside)
    return;
  if (selection.side == Side::inside)
    return found.inside.push_back(8 * corner);
  found.corner.push_back(8 * corner);
  found.value.resize(found.value.size() + 512);
  evaluator.evaluate(f_, selection, middle, frame_.spacing, arithmetic_, &found.value[found.value.size() - 512]);
  ++found.counts.blocks_evaluated;
  found.counts.group_visits += static_cast<int64_t>(selection.unit.size());
  found.counts.atom_visits += static_cast<int64_t>(selection.ln_weight.size());
  found.points += points_in_grid(frame_, 8 * corner);
  if (discard) {
    const auto value = std::span(found.value).last(512);
    const bool below = std::all_of(value.begin(), value.end(), [&](double v) { return v < o_.band_lower; });
    const bool above = std::all_of(value.begin(), value.end(), [&](double v) { return v > o_.band_upper; });
    if (!below && !above)
      return;
    if (above)
      found.inside.push_back(8 * corner);
    found.corner.pop_back();
    found.value.resize(found.value.size() - 512);
  }
}

void Search::work_through(const Node& node, Found& found, Selection& selection, Evaluator& evaluator) const {
  for (int32_t i = 0; i < node_blocks * node_blocks * node_blocks; ++i) {
    const Vec3i corner = node.corner + Vec3i{i / 16, i / 4 % 4, i % 4};
    if (in_grid(corner))
      evaluate(corner, nodes_.clusters(node), !o_.full, o_.full, found, selection, evaluator);
  }
}

/// Sorts blocks by corner and joins them into the grid.
void Search::collect(std::vector<Found>& found, BlockGrid& grid, SearchCounts& counts) const {
  struct From {
    Vec3i corner;
    const float* value;
  };
  std::vector<From> from;
  for (size_t b = 0; b < grid.corner.size(); ++b)
    from.push_back({grid.corner[b], &grid.value[512 * b]});
  for (const Found& f : found) {
    for (size_t b = 0; b < f.corner.size(); ++b)
      from.push_back({f.corner[b], &f.value[512 * b]});
    grid.inside.insert(grid.inside.end(), f.inside.begin(), f.inside.end());
    counts.blocks_visited += f.counts.blocks_visited;
    counts.blocks_evaluated += f.counts.blocks_evaluated;
    counts.group_visits += f.counts.group_visits;
    counts.atom_visits += f.counts.atom_visits;
    grid.info.analyzed_points += f.points;
  }
  par::sort(from, o_.threads, [](const From& a, const From& b) { return a.corner < b.corner; });
  std::vector<Vec3i> corner(from.size());
  std::vector<float> value(512 * from.size());
  par::for_n(static_cast<int64_t>(from.size()), o_.threads, 256, [&](int64_t i) {
    const auto b = static_cast<size_t>(i);
    corner[b] = from[b].corner;
    std::copy_n(from[b].value, 512, &value[512 * b]);
  });
  grid.corner = std::move(corner);
  grid.value = std::move(value);
  par::sort(grid.inside, o_.threads);
}

BlockGrid Search::run(SearchCounts& counts) {
  BlockGrid grid;
  grid.frame = frame_;
  grid.info.isovalue = o_.isovalue;
  grid.info.decay = f_.decay;
  grid.info.band_lower = o_.band_lower;
  grid.info.band_upper = o_.band_upper;
  grid.info.tolerance = o_.tolerance;
  grid.info.inside_value = static_cast<float>(std::max(2 * o_.isovalue, o_.band_upper));
  grid.info.atoms = f_.atoms();
  descend();
  const auto n = static_cast<int64_t>(nodes_.node.size());
  std::vector<Found> found(static_cast<size_t>(n));
  std::atomic<int64_t> done{0};
  par::for_n(n, o_.threads, 1, [&](int64_t i) {
    Selection selection;
    Evaluator evaluator;
    work_through(nodes_.node[static_cast<size_t>(i)], found[static_cast<size_t>(i)], selection, evaluator);
    if (o_.progress)
      o_.progress(++done, n);
  });
  collect(found, grid, counts);

  // Blocks that bounds left out next to a band cell: their points are on its corners, and lie where the bounds say.
  const std::vector<Vec3i> missing = blocks_missing_from_band(grid, o_.threads);
  found.assign(missing.size(), {});
  par::for_n(static_cast<int64_t>(missing.size()), o_.threads, 16, [&](int64_t i) {
    const auto b = static_cast<size_t>(i);
    const Vec3i block{missing[b].x >> 3, missing[b].y >> 3, missing[b].z >> 3};
    const Vec3i first{frame_.lower.x >> 3, frame_.lower.y >> 3, frame_.lower.z >> 3};
    const Vec3i in = block - first, node = first + Vec3i{in.x & ~3, in.y & ~3, in.z & ~3};
    const auto at = std::lower_bound(nodes_.node.begin(), nodes_.node.end(), node,
                                     [](const Node& a, Vec3i c) { return a.corner < c; });
    const bool there = at != nodes_.node.end() && at->corner == node;
    Selection selection;
    Evaluator evaluator;
    evaluate(block, there ? nodes_.clusters(*at) : std::span<const int32_t>(), false, false, found[b], selection,
             evaluator);
  });
  collect(found, grid, counts);
  if (o_.full)
    grid.info.analyzed_points = int64_t{frame_.points.x} * frame_.points.y * frame_.points.z;
  keep_band(grid, o_.threads, counts.active_points);
  return grid;
}

} // namespace

BlockGrid find_band(const Field& f, const GridFrame& frame, const SearchOptions& options, SearchCounts& counts) {
  return Search(f, frame, options).run(counts);
}

bool wall_cuts_surface(const BlockGrid& grid) {
  const Vec3i lo = grid.frame.lower, last = lo + grid.frame.points - Vec3i{1, 1, 1};
  const auto on_wall = [&](Vec3i p) {
    return p.x == lo.x || p.y == lo.y || p.z == lo.z || p.x == last.x || p.y == last.y || p.z == last.z;
  };
  const auto cut = [&](Vec3i corner, auto inside) {
    for (int s = 0; s < 512; ++s) {
      const Vec3i p = corner + Vec3i{s >> 6, s >> 3 & 7, s & 7};
      if (on_wall(p) && inside(s))
        return true;
    }
    return false;
  };
  for (size_t b = 0; b < grid.corner.size(); ++b)
    if (cut(grid.corner[b],
            [&](int s) { return grid.value[512 * b + static_cast<size_t>(s)] > grid.info.isovalue; }))
      return true;
  return std::any_of(grid.inside.begin(), grid.inside.end(),
                     [&](Vec3i c) { return cut(c, [](int) { return true; }); });
}

} // namespace molmesh::density
