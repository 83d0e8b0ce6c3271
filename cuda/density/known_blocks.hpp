// known_blocks.hpp — keeps what waves have found, lists the blocks that the band still needs, and brings the band
// to the host.
#pragma once
#include "cuda/density/neighboring_search_items.hpp"
#include "cuda/par/run_copy.hpp"
#include "grid/band.hpp"
#include "par/pages.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>
#include <numeric>
#include <vector>

namespace molmesh::cuda {

/// Blocks [begin, end) along x.
struct SlabRange {
  int32_t begin, end;
};

template <class Backend>
void sort_keys(Backend& b, Key* key, int64_t n) {
  const auto none = b.filled(n, uint32_t{0});
  b.sort_pairs("sort keys", key, none.data(), n);
}

/// Values of blocks, 512 each, and their bits below and above the band, 16 words each.
template <class Backend>
struct Evaluated {
  typename Backend::template Array<float> value;
  typename Backend::template Array<uint64_t> mask;
};

/// KnownView's arrays.
template <class Backend>
struct Known {
  typename Backend::template Array<Key> key;
  typename Backend::template Array<const uint64_t*> mask;
  typename Backend::template Array<const float*> value;
  int64_t n = 0;
};

/// A slab of the band, packed: keys of its blocks, 16 words of bits each, values; and blocks wholly inside.
template <class Backend>
struct SlabResult {
  typename Backend::template Array<Key> key;
  typename Backend::template Array<uint64_t> bits;
  typename Backend::template Array<float> packed;
  typename Backend::template Array<Key> inside;
};

template <class Backend>
class BandBlocks {
  template <class T>
  using Array = typename Backend::template Array<T>;
  using Known = cuda::Known<Backend>;
  using Evaluated = cuda::Evaluated<Backend>;
  using SlabResult = cuda::SlabResult<Backend>;

public:
  BandBlocks(Backend& b, const BlockFrame& frame) : b_(b), frame_(frame) {
    std::vector<uint64_t> sides(32, 0); // all below, all above
    std::fill_n(sides.begin(), 8, ~uint64_t{0});
    std::fill_n(sides.begin() + 24, 8, ~uint64_t{0});
    sides_ = b_.upload(sides.data(), 32);
  }
  const uint64_t* all_above() const { return sides_.data() + 16; }

  /// Ascending, each once: blocks without values that have a corner of a band cell.
  Array<Key> missing(const Known& known, SlabRange slab, int64_t& n) const {
    const Array<int64_t> count = b_.template array<int64_t>(known.n + 1);
    MissingNeighbors item{view(known), frame_, slab.begin, slab.end, count.data(), nullptr};
    b_.for_n("find missing neighbours", known.n, item, {double(known.n) * (128 + 24)});
    const int64_t all = b_.scan("scan", count.data(), known.n);
    const Array<Key> found = b_.template array<Key>(all);
    item.out = found.data();
    if (all > 0)
      b_.for_n("list missing neighbours", known.n, item, {double(known.n) * (128 + 24)});
    sort_keys(b_, found.data(), all);
    const Array<int64_t> first = b_.template array<int64_t>(all + 1);
    b_.for_n("first of equal", all, FirstOfEqual{found.data(), first.data()}, {double(all) * 16});
    n = b_.scan("scan", first.data(), all);
    Array<Key> out = b_.template array<Key>(n);
    b_.for_n("compact", all, par::Compact<Key>{found.data(), first.data(), out.data()}, {double(all) * 16});
    return out;
  }

  Known merge(const Known& known, const Array<Key>& more, int64_t n_more, const Evaluated& e) const {
    const int64_t n = known.n + n_more;
    Known k{b_.template array<Key>(n), b_.template array<const uint64_t*>(n), b_.template array<const float*>(n),
            0};
    const Array<uint32_t> index = b_.template array<uint32_t>(n);
    const Array<int64_t> replaced = b_.template array<int64_t>(n + 1);
    b_.for_n("merge", n, MergeKeys{view(known), more.data(), n_more, k.key.data(), index.data(), replaced.data()},
             {double(n) * 28});
    k.n = n - b_.scan("scan", replaced.data(), n);
    b_.sort_pairs("sort keys", k.key.data(), index.data(), n);
    b_.for_n("merge", k.n,
             MergeKnown{view(known), index.data(), e.mask.data(), e.value.data(), k.mask.data(), k.value.data()},
             {double(n) * 36});
    return k;
  }

  SlabResult pack(const Known& known, SlabRange slab) const {
    std::vector<Key> key(static_cast<size_t>(known.n));
    b_.download(known.key, known.n, key.data());
    const auto at = [&](int32_t x) {
      return std::lower_bound(key.begin(), key.end(), BlockFrame::key({std::max(x, 0), 0, 0})) - key.begin();
    };
    const int64_t first = at(slab.begin), n = at(slab.end) - first;
    const KnownView all = view(known);
    const Array<uint64_t> active = b_.template array<uint64_t>(8 * n);
    const Array<int64_t> points = b_.template array<int64_t>(n + 1), blocks = b_.template array<int64_t>(n + 1);
    b_.for_n("find active points", n, ActivePoints{all, frame_, first, active.data(), points.data(), blocks.data()},
             {double(n) * (128 + 64 + 16)});
    const int64_t n_points = b_.scan("scan", points.data(), n), n_blocks = b_.scan("scan", blocks.data(), n);
    Array<Key> out_key = b_.template array<Key>(n_blocks);
    Array<uint64_t> bits = b_.template array<uint64_t>(16 * n_blocks);
    Array<float> packed = b_.template array<float>(n_points);
    b_.for_n("pack the band", n,
             PackBand{all, first, active.data(), points.data(), blocks.data(), out_key.data(), bits.data(),
                      packed.data()},
             {double(n_blocks) * (8 + 3 * 64) + double(n_points) * 8});
    const Array<int64_t> inside = b_.template array<int64_t>(n + 1);
    InsideBlocks item{all, first, blocks.data(), inside.data(), nullptr};
    b_.for_n("find inside blocks", n, item, {double(n) * 24});
    const int64_t n_inside = b_.scan("scan", inside.data(), n);
    Array<Key> inside_key = b_.template array<Key>(n_inside);
    item.out = inside_key.data();
    b_.for_n("find inside blocks", n, item, {double(n) * 24});
    b_.settle();
    return {std::move(out_key), std::move(bits), std::move(packed), std::move(inside_key)};
  }

  /// By another thread than the device's, with threads of the host, while the device goes on.
  void append(const SlabResult& r, Band& band, int threads) const {
    RunCopy<Backend> copy(b_, threads, RunCopy<Backend>::usual_bytes, true);
    const auto all = [&](const auto& array, auto& to, size_t more = 0) {
      par::resize_pages(to, static_cast<size_t>(array.size()) + more, threads);
      copy.send(array.data(), array.size(), to.data());
    };
    LargeArray<Key> key, inside;
    LargeArray<uint64_t> bits;
    all(r.key, key);
    all(r.inside, inside);
    all(r.bits, bits);
    LargeArray<float>& store = band.storage.emplace_back();
    all(r.packed, store, 16); // vectors read behind them
    copy.finish();
    const int64_t blocks = r.key.size();
    const size_t first = band.block.size();
    std::vector<int64_t> start(key.size());
    par::for_n(blocks, threads, [&](int64_t i) {
      const uint64_t* const active = bits.data() + 16 * i;
      start[i] = std::accumulate(active, active + 8, int64_t{0},
                                 [](int64_t sum, uint64_t word) { return sum + std::popcount(word); });
    });
    par::exclusive_scan(start);
    band.block.resize(first + key.size());
    par::for_n(blocks, threads, [&](int64_t i) {
      const auto n = static_cast<size_t>(i);
      BandBlock& block = band.block[first + n];
      block.corner = frame_.corner(BlockFrame::block(key[n]));
      std::copy_n(bits.data() + 16 * i, 8, block.active.data());
      std::copy_n(bits.data() + 16 * i + 8, 8, block.above.data());
      block.stored = block.active;
      block.value = store.data() + start[n];
    });
    band.active_points += r.packed.size();
    for (const Key k : inside)
      band.inside.push_back(frame_.corner(BlockFrame::block(k)));
  }

private:
  KnownView view(const Known& k) const { return {k.key.data(), k.mask.data(), k.value.data(), k.n, sides_.data()}; }

  Backend& b_;
  const BlockFrame& frame_;
  Array<uint64_t> sides_;
};

} // namespace molmesh::cuda
