// brick_state.cpp — finds the neighbors of bricks and puts blocks in order.
#include "density/band/brick_state.hpp"
#include "base/galloping_search.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>

namespace molmesh::density {
namespace {

bool before_corner(const BrickState& s, Vec3i c) {
  return s.corner < c;
}

uint64_t run(uint64_t blocks, int first) {
  return blocks >> first & 15;
}

} // namespace

unsigned open_faces(const BrickState& s) {
  if (!s.sides)
    return s.inside ? 63 : 0;
  const FacedBits& below = s.sides->below;
  const uint32_t* const face[6] = {below.row[0],    below.row[brick_edge - 1], below.y_face[0],
                                   below.y_face[1], below.z_face[0],           below.z_face[1]};
  unsigned open = 0;
  for (unsigned i = 0; i < 6; ++i)
    open |= unsigned{std::any_of(face[i], face[i] + brick_edge, [](uint32_t row) { return row != ~0u; })} << i;
  return open;
}

bool sides_around(const SlabState& before, const SlabState& slab, const SlabState& after, const BrickState& s,
                  RowHints& hint, const FacedBits** below, const FacedBits** above) {
  static const std::unique_ptr<const Sides> outside = [] {
    auto sides = std::make_unique<Sides>();
    std::fill_n(&sides->below.row[0][0], brick_edge * brick_edge, ~0u);
    for (auto* const faces : {sides->below.y_face, sides->below.z_face})
      std::fill_n(&faces[0][0], 2 * brick_edge, ~0u);
    return sides;
  }();
  const SlabState* const slabs[3] = {&before, &slab, &after};
  bool mixed = false;
  for (int n = 0; n < 27; n += 3) {
    const std::vector<BrickState>& bricks = slabs[n / 9]->brick;
    auto at = galloping_lower_bound(bricks.begin(), bricks.end(), hint[n / 3],
                                    s.corner + brick_blocks * direction(n), before_corner);
    for (int z = n; z < n + 3; ++z) {
      below[z] = &outside->below;
      above[z] = &outside->above;
      if (at == bricks.end() || !(at->corner == s.corner + brick_blocks * direction(z)))
        continue;
      if (at->sides) {
        below[z] = &at->sides->below;
        above[z] = &at->sides->above;
      } else if (at->inside) {
        std::swap(below[z], above[z]);
      }
      mixed = mixed || at->sides;
      ++at;
    }
  }
  return mixed || std::any_of(below, below + 27, [&](const FacedBits* b) { return b != below[0]; });
}

void add_needed(const SlabState& before, SlabState& slab, const SlabState& after) {
  std::vector<Vec3i> needed;
  for (const SlabState* const s : {&before, static_cast<const SlabState*>(&slab), &after})
    for (const BrickState& n : s->brick)
      std::copy_if(n.needed.begin(), n.needed.end(), std::back_inserter(needed),
                   [&](Vec3i c) { return c.x == slab.x; });
  if (needed.empty())
    return;
  par::sort_unique(needed, 1);
  for (const Vec3i& c : needed)
    slab.brick.emplace_back().corner = c;
  std::sort(slab.brick.begin(), slab.brick.end(),
            [](const BrickState& a, const BrickState& b) { return a.corner < b.corner; });
}

SlabAppend::SlabAppend(const SlabState& slab, bool with_blocks, Band& band) : slab_(slab), blocks_(with_blocks) {
  for (size_t i = 0; i < slab.brick.size(); ++i)
    if (rows_.empty() || slab.brick[i].corner.y != slab.brick[rows_.back().begin].corner.y)
      rows_.push_back({i, i + 1});
    else
      rows_.back().end = i + 1;
  std::vector<int64_t> kept, closed;
  for (int x = 0; x < brick_blocks; ++x)
    for (const Row& row : rows_) {
      int64_t k = 0, c = 0;
      for (size_t i = row.begin; i < row.end; ++i) {
        k += blocks_ ? std::popcount(slab.brick[i].kept >> 16 * x & 0xffff) : 0;
        c += std::popcount(slab.brick[i].closed >> 16 * x & 0xffff);
      }
      kept.push_back(k);
      closed.push_back(c);
    }
  const size_t blocks = band.block.size(), inside = band.inside.size();
  kept.push_back(par::exclusive_scan(kept));
  closed.push_back(par::exclusive_scan(closed));
  band.block.resize(blocks + static_cast<size_t>(kept.back()));
  band.inside.resize(inside + static_cast<size_t>(closed.back()));
  for (const int64_t k : kept)
    block_.push_back(band.block.data() + blocks + k);
  for (const int64_t c : closed)
    inside_.push_back(band.inside.data() + inside + c);
  parts_ = static_cast<int64_t>((kept.size() - 1 + rows_at_once - 1) / rows_at_once);
}

/// Calls use(brick, first) for every run of four blocks along z, ascending.
template <class Use>
void SlabAppend::for_runs(size_t layer_of_row, Use&& use) const {
  const int x = static_cast<int>(layer_of_row / rows_.size());
  const Row row = rows_[layer_of_row % rows_.size()];
  for (int y = 0; y < brick_blocks; ++y)
    for (size_t i = row.begin; i < row.end; ++i)
      use(slab_.brick[i], 16 * x + 4 * y);
}

void SlabAppend::copy(int64_t part) const {
  const size_t begin = static_cast<size_t>(part) * rows_at_once,
               end = std::min(begin + rows_at_once, block_.size() - 1);
  prepare_pages(block_[begin], static_cast<size_t>(block_[end] - block_[begin]) * sizeof(BandBlock));
  for (size_t r = begin; r < end; ++r) {
    BandBlock* block = block_[r];
    Vec3i* inside = inside_[r];
    for_runs(r, [&](const BrickState& s, int first) {
      if (blocks_) {
        const auto skipped = std::popcount(s.kept & ((uint64_t{1} << first) - 1));
        block = std::copy_n(s.band.begin() + skipped, std::popcount(run(s.kept, first)), block);
      }
      for (int z = 0; z < brick_blocks; ++z)
        if (s.closed >> (first + z) & 1)
          *inside++ = 8 * (s.corner + block_at(first + z));
    });
  }
}

} // namespace molmesh::density
