// search.cpp — the blocks that bounds cannot decide, node by node, slab by slab; then the band between them.
#include "density/search.hpp"
#include "density/node_search.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <atomic>

namespace molmesh::density {
namespace {

class Search {
public:
  Search(const Field& f, const GridFrame& frame, const SearchOptions& o)
      : f_(f), frame_(frame), o_(o), arithmetic_(arithmetic_for(f, o.tolerance)) {}
  Band run(SearchCounts& counts);

private:
  SlabState find_slab(int32_t x);
  void finish_slab(const SlabState& before, SlabState& slab, const SlabState& after, Band& band);
  template <class F>
  void for_nodes(SlabState& slab, F&& work);

  const Field& f_;
  const GridFrame& frame_;
  const SearchOptions& o_;
  const Arithmetic arithmetic_;
  NodeList nodes_;
  const NodeSearch node_{f_, frame_, o_, nodes_};
  Workspaces workspaces_;
  std::atomic<int64_t> done_{0};
};

template <class F>
void Search::for_nodes(SlabState& slab, F&& work) {
  par::for_n(static_cast<int64_t>(slab.node.size()), o_.threads, 1, [&](int64_t i) {
    std::unique_ptr<Workspace> w = workspaces_.borrow([this] {
      return std::make_unique<Workspace>(
          Workspace{Selection(f_, budget_for(o_), o_.band_lower, o_.band_upper, arithmetic_)});
    });
    work(slab.node[static_cast<size_t>(i)], *w);
    workspaces_.give_back(std::move(w));
  });
}

SlabState Search::find_slab(int32_t x) {
  const auto at = [&](int32_t corner_x) {
    return std::partition_point(nodes_.node.begin(), nodes_.node.end(),
                                [=](const Node& n) { return n.corner.x < corner_x; });
  };
  const std::span<const Node> nodes(at(x), at(x + node_blocks));
  SlabState slab{x, std::vector<NodeState>(nodes.size())};
  for_nodes(slab, [&](NodeState& s, Workspace& w) {
    const Node& node = nodes[static_cast<size_t>(&s - slab.node.data())];
    s.corner = node.corner;
    node_.work_through(node, s, w);
    if (o_.progress)
      o_.progress(++done_, static_cast<int64_t>(nodes_.node.size()));
  });
  return slab;
}

void Search::finish_slab(const SlabState& before, SlabState& slab, const SlabState& after, Band& band) {
  add_needed(before, slab, after);
  for_nodes(slab, [&](NodeState& s, Workspace& w) {
    const NodeBits *below[27], *above[27];
    s.closed = s.inside;
    if (sides_around(before, slab, after, s, below, above))
      node_.finish(s, below, above, w);
  });
  append(slab, band, o_.threads);
}

/// Slab by slab of nodes along x, so that only two slabs hold the sides of all their points.
Band Search::run(SearchCounts& counts) {
  Band band = empty_band(f_, frame_, o_);
  nodes_ = o_.atoms == AtomSearch::kdtree ? nodes_by_tree(f_, frame_, o_.full, o_.threads)
                                          : nodes_by_halving(f_, frame_, o_.full, o_.threads);
  band.block.reserve(blocks_a_node * nodes_.node.size()); // address space; pages come when they are used
  const int32_t first = first_block(frame_).x, end = (frame_.lower.x + frame_.points.x + 7) >> 3;
  SlabState before, slab;
  for (int32_t x = first; x < end + node_blocks; x += node_blocks) {
    SlabState next = find_slab(x);
    if (x > first)
      finish_slab(before, slab, next, band);
    before = std::move(slab);
    slab = std::move(next);
  }
  int64_t points = 0;
  counts = {};
  for (const std::unique_ptr<Workspace>& w : workspaces_.all()) {
    counts.blocks_visited += w->counts.blocks_visited;
    counts.blocks_evaluated += w->counts.blocks_evaluated;
    counts.group_visits += w->counts.group_visits;
    counts.atom_visits += w->counts.atom_visits;
    counts.active_points += w->counts.active_points;
    points += w->points;
    for (LargeArray<float>& chunk : w->packed.release())
      band.storage.push_back(std::move(chunk));
  }
  band.active_points = counts.active_points;
  band.info.analyzed_points = o_.full ? int64_t{frame_.points.x} * frame_.points.y * frame_.points.z : points;
  return band;
}

} // namespace

Band empty_band(const Field& f, const GridFrame& frame, const SearchOptions& o) {
  Band band;
  band.frame = frame;
  band.info.isovalue = o.isovalue;
  band.info.decay = f.decay;
  band.info.band_lower = o.band_lower;
  band.info.band_upper = o.band_upper;
  band.info.tolerance = o.tolerance;
  band.info.inside_value = static_cast<float>(std::max(2 * o.isovalue, o.band_upper));
  band.info.atoms = f.atoms();
  return band;
}

Budget budget_for(const SearchOptions& o) {
  Budget b(o.tolerance);
  if (o.atoms == AtomSearch::all)
    b.far = b.part = b.block = b.within = b.digits = 0;
  return b;
}

Band find_band(const Field& f, const GridFrame& frame, const SearchOptions& options, SearchCounts& counts) {
  return Search(f, frame, options).run(counts);
}

} // namespace molmesh::density
