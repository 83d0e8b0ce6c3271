// neighboring_search.hpp — the sparse density grid on a Backend: neighbouring search in waves of blocks (§3.1 of
// Liao et al. 2013), atoms through the molecule's own boxes (§3.2), blocks of similar work together (§3.3). The
// first wave is every block that bounds on G cannot put on a side, so every component and every cavity has its
// seeds; the next are the blocks beside it that turn out to have a corner of a band cell. Slabs of blocks, each
// with a layer more on either side, one after the other, where the device's memory asks for it.
#pragma once
#include "cuda/density/block_evaluation.hpp"
#include "cuda/density/device_field.hpp"
#include "cuda/density/known_blocks.hpp"
#include "density/band/neighboring_search.hpp"
#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <memory>

namespace molmesh::cuda {

template <class Backend>
class Search {
  template <class T>
  using Array = typename Backend::template Array<T>;

public:
  Search(Backend& backend, const density::Field& f, const GridFrame& frame, const density::SearchOptions& o)
      : b_(backend), field_(f), o_(o), budget_(density::budget_for(o)), single_(single_holds(f, o.tolerance)),
        stored_(backend, f), view_(stored_.view), blocks_(backend, frame_) {
    frame_.grid = frame;
    for (int a = 0; a < 3; ++a) {
      frame_.first[a] = frame.lower[a] >> 3;
      frame_.blocks[a] = ((frame.lower[a] + frame.points[a] + 7) >> 3) - frame_.first[a];
      if (frame_.blocks[a] >= 1 << key_bits)
        fail(Status::failed, "mode cuda: the grid has more than 2^24 points along an axis, use seq or omp",
             {"mode"});
    }
  }

  Band run(density::SearchCounts& counts) {
    Band band = density::empty_band(field_, frame_.grid, o_);
    find_bricks();
    std::unique_ptr<SlabResult> before;
    std::future<void> taken; // of `before`, by the host's threads
    const auto take = [&] {
      if (before)
        taken.get();
      before.reset();
    };
    std::vector<SlabRange> todo = plan();
    std::reverse(todo.begin(), todo.end());
    while (!todo.empty()) {
      const SlabRange s = todo.back();
      todo.pop_back();
      std::unique_ptr<SlabResult> result;
      try {
        result = std::make_unique<SlabResult>(run_slab(s));
      } catch (const OutOfRoom&) {
        if (before) { // what is still on its way to the host
          take();
          todo.push_back(s);
          continue;
        }
        if (s.end - s.begin < 2)
          throw;
        const int32_t middle = (s.begin + s.end) / 2;
        todo.push_back({middle, s.end});
        todo.push_back({s.begin, middle});
        continue;
      }
      take();
      before = std::move(result);
      taken = std::async(std::launch::async, [&, slab = before.get()] { give_away(*slab, band); });
      ++slabs_;
      if (o_.progress)
        o_.progress(s.end, frame_.blocks.x);
    }
    take();
    band.info.analyzed_points =
        o_.full ? int64_t{frame_.grid.points.x} * frame_.grid.points.y * frame_.grid.points.z : analyzed_;
    counts = counts_;
    counts.active_points = band.active_points;
    return band;
  }
  int64_t slabs() const { return slabs_; }

private:
  static constexpr int32_t brick_edge = 4;
  using Evaluated = cuda::Evaluated<Backend>;
  using Known = cuda::Known<Backend>;
  using SlabResult = cuda::SlabResult<Backend>;

  void give_away(const SlabResult& slab, Band& band) const {
    blocks_.append(slab, band, o_.threads);
    if (!o_.take || band.block.empty())
      return;
    const molmesh::BandBlocks all = band.block;
    o_.take(band.info, {&all, 1});
    band.block.clear();
    band.storage.clear();
  }

  /// Cubes with the given edge from those of twice the edge.
  Array<Key> halve(const Array<Key>& parent, int64_t parents, int32_t edge, SlabRange x, int64_t& n) {
    const int64_t children = 8 * parents;
    Array<Key> child = b_.template array<Key>(children);
    Array<int64_t> kept = b_.template array<int64_t>(children + 1);
    b_.for_n("halve cubes", children,
             HalveCubes{view_, frame_, o_.full, edge, x.begin, x.end, parent.data(), child.data(), kept.data()},
             {double(children) * 16});
    n = b_.scan("scan", kept.data(), children);
    Array<Key> out = b_.template array<Key>(n);
    b_.for_n("compact", children, par::Compact<Key>{child.data(), kept.data(), out.data()},
             {double(children) * 16});
    return out;
  }

  /// Cubes of node_edge³ blocks near atoms: few enough for the host to plan with.
  void find_bricks() {
    int32_t edge = brick_edge;
    while (edge < std::max({frame_.blocks.x, frame_.blocks.y, frame_.blocks.z}))
      edge *= 2;
    const Key root = 0;
    int64_t n = 1;
    Array<Key> cubes = b_.upload(&root, 1);
    while (edge > brick_edge) {
      edge /= 2;
      cubes = halve(cubes, n, edge, {0, frame_.blocks.x}, n);
    }
    bricks_.resize(static_cast<size_t>(n));
    b_.download(cubes, n, bricks_.data());
    std::sort(bricks_.begin(), bricks_.end());
  }

  /// As few slabs as memory allows if every block near an atom were evaluated with a generous list; a few where
  /// there is much to do, so that copies have kernels to run beside.
  std::vector<SlabRange> plan() const {
    constexpr int64_t bytes_a_block =
        512 * 4 + 512 * 4 + 16 * 8 + 8 * 40 + 4 * 256; // values, packed, bits, keys, list
    constexpr int64_t blocks_a_brick = brick_edge * brick_edge * brick_edge, slabs_beside = 4,
                      worth = int64_t{1} << 16;
    const int64_t all = blocks_a_brick * static_cast<int64_t>(bricks_.size());
    const int64_t most =
        std::max<int64_t>(std::min(b_.room() / bytes_a_block, std::max(worth, all / slabs_beside + 1)), 1);
    std::vector<int64_t> blocks(static_cast<size_t>((frame_.blocks.x + brick_edge - 1) / brick_edge), 0);
    for (const Key k : bricks_)
      blocks[BlockFrame::block(k).x / brick_edge] += blocks_a_brick;
    std::vector<SlabRange> slabs;
    int64_t sum = 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
      const auto begin = static_cast<int32_t>(i) * brick_edge;
      if (slabs.empty() || sum + blocks[i] > most) {
        slabs.push_back({begin, begin});
        sum = 0;
      }
      sum += blocks[i];
      slabs.back().end = std::min(begin + brick_edge, frame_.blocks.x);
    }
    return slabs;
  }

  /// A slab's blocks near atoms, and the clusters near cubes of them.
  struct Candidates {
    Array<Key> block, cube;
    Array<int64_t> begin;
    Array<int32_t> list;
    int64_t n = 0;
    NearClusters near{};
  };
  /// Few blocks share a long list, many a short one: cubes of about the clusters' reach.
  int32_t list_edge() const {
    constexpr double reach = 10; // Å
    int32_t edge = brick_edge;
    while (edge > 1 && 8 * edge * frame_.grid.spacing > reach)
      edge /= 2;
    return edge;
  }
  void list_near(Candidates& to, const Array<Key>& cubes, int64_t n, int32_t edge) {
    to.cube = b_.template array<Key>(n);
    b_.for_n("copy", n, par::CopyItems<Key>{cubes.data(), to.cube.data()}, {double(n) * 16});
    sort_keys(b_, to.cube.data(), n);
    to.begin = b_.template array<int64_t>(n + 1);
    ListNearCubes item{view_, frame_, edge, to.cube.data(), to.begin.data(), nullptr};
    b_.for_n("count near clusters", n, item, {double(n) * 16});
    const int64_t all = b_.scan("scan", to.begin.data(), n);
    to.list = b_.template array<int32_t>(all + 1); // never null
    item.list = to.list.data();
    b_.for_n("list near clusters", n, item, {double(n) * 16 + double(all) * 4});
    to.near = {view_, frame_, edge, to.cube.data(), to.begin.data(), to.list.data(), n};
  }
  Candidates candidates(SlabRange wide) {
    std::vector<Key> bricks;
    for (const Key k : bricks_)
      if (const int32_t x = BlockFrame::block(k).x; x < wide.end && x + brick_edge > wide.begin)
        bricks.push_back(k);
    Candidates found;
    found.n = static_cast<int64_t>(bricks.size());
    found.block = b_.upload(bricks.data(), found.n);
    for (int32_t edge = brick_edge;; edge /= 2) {
      if (edge == list_edge())
        list_near(found, found.block, found.n, edge);
      if (edge == 1)
        break;
      found.block = halve(found.block, found.n, edge / 2, wide, found.n);
    }
    sort_keys(b_, found.block.data(), found.n);
    return found;
  }

  Evaluated evaluate(const NearClusters& near, const Array<Key>& key, int64_t n, SlabRange slab, int64_t& analyzed,
                     density::SearchCounts& counts) {
    const BlockClusters in{near, field_.plain_above && budget_.block > 0, budget_.block, key.data()};
    Array<int64_t> begin = b_.template array<int64_t>(n + 1);
    Array<uint32_t> order = b_.template array<uint32_t>(n);
    int64_t clusters = 0, atoms = 0;
    Array<int32_t> list;
    {
      const Array<uint32_t> work = b_.template array<uint32_t>(n);
      const Array<float> least = b_.template array<float>(n);
      b_.for_teams("choose clusters", n, ChooseLeast{in, least.data()}, {double(n) * 12});
      ListClusters listed{in, least.data(), begin.data(), work.data(), nullptr};
      b_.for_teams("count clusters", n, listed, {double(n) * 24});
      clusters = b_.scan("scan", begin.data(), n);
      list = b_.template array<int32_t>(clusters + 1); // never null
      listed.list = list.data();
      b_.for_teams("list clusters", n, listed, {double(n) * 20 + double(clusters) * 4});
      const Array<uint32_t> sort_key = b_.template array<uint32_t>(n);
      b_.for_n("estimate work", n, SortKeys{work.data(), sort_key.data(), order.data()}, {double(n) * 12});
      b_.sort_pairs("sort by work", sort_key.data(), order.data(), n);
      const Array<int64_t> sum = b_.template array<int64_t>(n + 1);
      b_.for_n("count atoms", n, Widen{work.data(), sum.data()}, {double(n) * 12});
      atoms = b_.scan("scan", sum.data(), n);
      b_.for_n("count points", n, CountPoints{frame_, slab.begin, slab.end, key.data(), sum.data()},
               {double(n) * 16});
      analyzed += b_.scan("scan", sum.data(), n);
    }
    counts.blocks_evaluated += n;
    counts.group_visits += clusters;
    counts.atom_visits += atoms;
    Evaluated e{b_.template array<float>(512 * n), b_.template array<uint64_t>(16 * n)};
    const Work work{double(n) * 2048 + double(atoms) * 32, 512.0 * double(atoms), !single_};
    if (single_)
      b_.for_teams(
          "sum atoms", n,
          EvaluateBlock{view_, frame_, key.data(), order.data(), begin.data(), list.data(), e.value.data()}, work);
    else
      b_.for_n("sum atoms by logarithms", 512 * n,
               EvaluatePoint{view_, frame_, key.data(), order.data(), begin.data(), list.data(), e.value.data()},
               work);
    b_.for_n(
        "compare with the band", 8 * n,
        PointMasks{density::float_band(o_).lower, density::float_band(o_).upper, e.value.data(), e.mask.data()},
        {double(n) * (2048 + 128)});
    return e;
  }

  SlabResult run_slab(SlabRange slab) {
    const SlabRange wide{slab.begin - 1, slab.end + 1};
    int64_t analyzed = 0;
    density::SearchCounts counts;
    const Candidates found = candidates(wide);
    const int64_t n = found.n;
    const Array<Key>& candidate = found.block;
    counts.blocks_visited = n;
    Known known;
    std::vector<Evaluated> wave; // known points into them
    {
      const Array<State> state = b_.template array<State>(n);
      const double total = budget_.far + budget_.block + budget_.within;
      const Work work{double(n) * 9};
      if (single_)
        b_.for_n("bound blocks", n,
                 BoundBlocks<float>{found.near, o_.band_lower, o_.band_upper, total, !o_.full, candidate.data(),
                                    state.data()},
                 work);
      else
        b_.for_n("bound blocks", n,
                 BoundBlocks<double>{found.near, o_.band_lower, o_.band_upper, total, !o_.full, candidate.data(),
                                     state.data()},
                 work);
      const Array<int64_t> open = b_.template array<int64_t>(n + 1), at = b_.template array<int64_t>(n + 1);
      b_.for_n("count states", n, CountStates{state.data(), open.data(), at.data()}, {double(n) * 17});
      const int64_t opens = b_.scan("scan", open.data(), n);
      known.n = b_.scan("scan", at.data(), n);
      const Array<Key> open_key = b_.template array<Key>(opens);
      b_.for_n("compact", n, par::Compact<Key>{candidate.data(), open.data(), open_key.data()}, {double(n) * 16});
      wave.push_back(evaluate(found.near, open_key, opens, slab, analyzed, counts));
      known.key = b_.template array<Key>(known.n);
      known.mask = b_.template array<const uint64_t*>(known.n);
      known.value = b_.template array<const float*>(known.n);
      b_.for_n("compact", n, par::Compact<Key>{candidate.data(), at.data(), known.key.data()}, {double(n) * 16});
      b_.for_n("gather known blocks", n,
               FillKnown{state.data(), open.data(), at.data(), wave.back().mask.data(), blocks_.all_above(),
                         wave.back().value.data(), known.mask.data(), known.value.data()},
               {double(n) * 33});
    }
    for (;;) {
      int64_t n_more = 0;
      const Array<Key> more = blocks_.missing(known, slab, n_more);
      if (n_more == 0)
        break;
      wave.push_back(evaluate(found.near, more, n_more, slab, analyzed, counts));
      known = blocks_.merge(known, more, n_more, wave.back());
    }
    SlabResult result = blocks_.pack(known, slab);
    analyzed_ += analyzed;
    counts_.blocks_visited += counts.blocks_visited;
    counts_.blocks_evaluated += counts.blocks_evaluated;
    counts_.group_visits += counts.group_visits;
    counts_.atom_visits += counts.atom_visits;
    return result;
  }

  Backend& b_;
  const density::Field& field_;
  const density::SearchOptions& o_;
  const density::Budget budget_;
  const bool single_;
  BlockFrame frame_;
  const DeviceField<Backend> stored_;
  const FieldView& view_;
  const BandBlocks<Backend> blocks_;
  std::vector<Key> bricks_; ///< ascending
  density::SearchCounts counts_;
  int64_t analyzed_ = 0, slabs_ = 0;
};

} // namespace molmesh::cuda
