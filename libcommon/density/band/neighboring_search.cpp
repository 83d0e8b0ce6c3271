// neighboring_search.cpp — decides blocks brick by brick and slab by slab, then finds the band between them.
#include "density/band/neighboring_search.hpp"
#include "density/band/brick_search.hpp"
#include "density/culling/bvh.hpp"
#include "density/culling/kd_tree.hpp"
#include "par/par.hpp"
#include "par/pool.hpp"
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace molmesh::density {
namespace {

class Search {
public:
  Search(const Field& f, const GridFrame& frame, const SearchOptions& o)
      : f_(f), frame_(frame), o_(o), arithmetic_(arithmetic_for(f, o.tolerance)),
        own_(blocks_of(frame, slab_of(frame, o.tile))) {}
  Band run(SearchCounts& counts);

private:
  SlabState slab_at(int32_t x) const;
  void find(SlabState& slab, size_t brick, Workspace& w);
  void finish(const SlabState& before, SlabState& slab, const SlabState& after, size_t brick, Workspace& w) const;
  void give_away(const SlabState& slab, const FieldInfo& info);
  void forget(SlabState& slab);
  template <class Work>
  void with_workspace(Work&& work);

  const Field& f_;
  const GridFrame& frame_;
  const SearchOptions& o_;
  const Arithmetic arithmetic_;
  const BlockRange own_; ///< blocks that are wanted
  BrickList bricks_;     ///< theirs, and those next to them
  const BrickSearch brick_{f_, frame_, o_, own_, bricks_};
  par::Pool<Workspace> workspaces_;
  size_t turn_ = 0; ///< of Workspace::begin
  std::atomic<int64_t> done_{0};
};

template <class Work>
void Search::with_workspace(Work&& work) {
  const auto make = [this] {
    return std::make_unique<Workspace>(
        Workspace{BlockAtoms(f_, budget_for(o_), o_.band_lower, o_.band_upper, arithmetic_)});
  };
  workspaces_.with(make, [&](Workspace& w) {
    w.begin(turn_);
    work(w);
  });
}

/// The blocks of a finished slab, where the band does not keep them.
void Search::give_away(const SlabState& slab, const FieldInfo& info) {
  if (!o_.take)
    return;
  std::vector<BandBlocks> runs;
  for (const BrickState& s : slab.brick)
    if (!s.band.empty())
      runs.push_back(s.band);
  if (!runs.empty())
    o_.take(info, runs);
  ++turn_;
}

/// Leaves a slab's memory to the next ones, as much to each thread.
void Search::forget(SlabState& slab) {
  const std::vector<std::unique_ptr<Workspace>>& all = workspaces_.all();
  for (size_t i = 0; i < slab.brick.size(); ++i)
    all[i % all.size()]->spares.forget(slab.brick[i]);
  slab = {};
}

SlabState Search::slab_at(int32_t x) const {
  const auto at = [&](int32_t corner_x) {
    return std::partition_point(bricks_.brick.begin(), bricks_.brick.end(),
                                [=](const Brick& n) { return n.corner.x < corner_x; });
  };
  const auto begin = at(x);
  return {x, begin - bricks_.brick.begin(),
          std::vector<BrickState>(static_cast<size_t>(at(x + brick_blocks) - begin))};
}

void Search::find(SlabState& slab, size_t brick, Workspace& w) {
  const Brick& from = bricks_.brick[static_cast<size_t>(slab.first) + brick];
  BrickState& s = slab.brick[brick];
  s.corner = from.corner;
  brick_.work_through(from, s, w);
  if (o_.progress)
    o_.progress(++done_, static_cast<int64_t>(bricks_.brick.size()));
}

void Search::finish(const SlabState& before, SlabState& slab, const SlabState& after, size_t brick,
                    Workspace& w) const {
  BrickState& s = slab.brick[brick];
  if (!own_.meets(s.corner, brick_blocks))
    return;
  const FacedBits *below[27], *above[27];
  s.closed = s.inside;
  if (sides_around(before, slab, after, s, w.near_finished, below, above))
    brick_.finish(s, below, above, w);
}

/// Slab by slab of bricks along x, so that only a few hold the sides of all their points: one is found while the
/// one two before goes into the band, then the one before is finished.
Band Search::run(SearchCounts& counts) {
  Band band = empty_band(f_, frame_, o_);
  const Slab slab_of_tile = slab_of(frame_, o_.tile);
  if (!own_.empty()) {
    const auto bricks_by = o_.atoms == AtomSearch::kdtree ? bricks_by_kd_tree : bricks_by_bvh;
    bricks_ = bricks_by(f_, frame_, blocks_of(frame_, slab_of_tile, brick_blocks), o_.full, o_.threads);
  }
  constexpr size_t many = size_t{1} << 22;
  if (!o_.take)
    band.block.reserve(std::min(blocks_a_brick * bricks_.brick.size(), many)); // pages come when they are used
  const int32_t first = first_block(frame_).x, end = (frame_.lower.x + frame_.points.x + 7) >> 3;
  std::array<SlabState, slabs_at_work> slab;
  for (int32_t x = first; x < end + 2 * brick_blocks; x += brick_blocks) {
    forget(slab.back());
    std::rotate(slab.begin(), slab.end() - 1, slab.end());
    slab[0] = slab_at(x);
    const SlabAppend append(slab[2], !o_.take, band);
    const int64_t finds = slab[0].bricks();
    par::for_n(finds + append.parts(), o_.threads, 1, [&](int64_t i) {
      if (i >= finds)
        return append.copy(i - finds);
      with_workspace([&](Workspace& w) { find(slab[0], static_cast<size_t>(i), w); });
    });
    add_needed(slab[2], slab[1], slab[0]);
    par::for_n(slab[1].bricks(), o_.threads, 1, [&](int64_t i) {
      with_workspace([&](Workspace& w) { finish(slab[2], slab[1], slab[0], static_cast<size_t>(i), w); });
    });
    give_away(slab[1], band.info);
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
    if (!o_.take)
      for (LargeArray<float>& chunk : w->packed().release())
        band.storage.push_back(std::move(chunk));
  }
  band.active_points = counts.active_points;
  band.info.analyzed_points = o_.full ? points_of(frame_, slab_of_tile) : points;
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
  band.info.atoms = f.all_atoms;
  return band;
}

Box searched_box(const GridFrame& frame, Tile tile) {
  const BlockRange r = blocks_of(frame, slab_of(frame, tile), brick_blocks);
  // Cubes that are halved to bricks reach beyond the grid.
  const Box first = points_box(frame, r.begin, brick_blocks), last = points_box(frame, r.end, brick_blocks);
  return {first.lo, last.hi};
}

Budget budget_for(const SearchOptions& o) {
  Budget b(o.tolerance);
  if (o.atoms == AtomSearch::all)
    b.far = b.part = b.block = b.within = b.roots = b.digits = 0;
  return b;
}

FloatBand float_band(const SearchOptions& o) {
  const auto at_least = [](double v) {
    const auto f = static_cast<float>(v);
    return f >= v ? f : std::nextafter(f, std::numeric_limits<float>::infinity());
  };
  return {at_least(o.band_lower), -at_least(-o.band_upper)};
}

Band find_band(const Field& f, const GridFrame& frame, const SearchOptions& options, SearchCounts& counts) {
  return Search(f, frame, options).run(counts);
}

} // namespace molmesh::density
