// node_state.cpp — neighbors of nodes, and the order of blocks.
#include "density/node_state.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>

namespace molmesh::density {
namespace {

bool before_corner(const NodeState& s, Vec3i c) {
  return s.corner < c;
}

/// Nodes of one y, as positions in a slab.
struct Row {
  size_t begin, end;
};
std::vector<Row> rows_of(const SlabState& slab) {
  std::vector<Row> rows;
  for (size_t i = 0; i < slab.node.size(); ++i)
    if (rows.empty() || slab.node[i].corner.y != slab.node[rows.back().begin].corner.y)
      rows.push_back({i, i + 1});
    else
      rows.back().end = i + 1;
  return rows;
}

/// Calls use(node, first) for every run of four blocks along z, ascending, in layer x of a row of nodes.
template <class Use>
void for_runs(const SlabState& slab, Row row, int x, Use&& use) {
  for (int y = 0; y < node_blocks; ++y)
    for (size_t i = row.begin; i < row.end; ++i)
      use(slab.node[i], 16 * x + 4 * y);
}
uint64_t run(uint64_t blocks, int first) {
  return blocks >> first & 15;
}

} // namespace

unsigned open_faces(const NodeState& s) {
  if (!s.sides)
    return s.inside ? 63 : 0;
  const NodeBits& below = s.sides->below;
  uint32_t all[5] = {~0u, ~0u, ~0u, ~0u, ~0u}; // last: both faces of z
  for (int i = 0; i < node_edge; ++i) {
    all[0] &= below.row[0][i];
    all[1] &= below.row[node_edge - 1][i];
    all[2] &= below.row[i][0];
    all[3] &= below.row[i][node_edge - 1];
    for (int j = 0; j < node_edge; ++j)
      all[4] &= below.row[i][j];
  }
  unsigned open = unsigned{!(all[4] & 1)} << 4 | unsigned{!(all[4] >> 31)} << 5;
  for (unsigned face = 0; face < 4; ++face)
    open |= unsigned{all[face] != ~0u} << face;
  return open;
}

bool sides_around(const SlabState& before, const SlabState& slab, const SlabState& after, const NodeState& s,
                  const NodeBits** below, const NodeBits** above) {
  static const std::unique_ptr<const Sides> outside = [] {
    auto sides = std::make_unique<Sides>();
    std::fill_n(&sides->below.row[0][0], node_edge * node_edge, ~0u);
    return sides;
  }();
  const SlabState* const slabs[3] = {&before, &slab, &after};
  bool mixed = false;
  for (int n = 0; n < 27; n += 3) {
    const std::vector<NodeState>& nodes = slabs[n / 9]->node;
    auto at = std::lower_bound(nodes.begin(), nodes.end(), s.corner + node_blocks * direction(n), before_corner);
    for (int z = n; z < n + 3; ++z) {
      below[z] = &outside->below;
      above[z] = &outside->above;
      if (at == nodes.end() || !(at->corner == s.corner + node_blocks * direction(z)))
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
  return mixed || std::any_of(below, below + 27, [&](const NodeBits* b) { return b != below[0]; });
}

void add_needed(const SlabState& before, SlabState& slab, const SlabState& after) {
  std::vector<Vec3i> needed;
  for (const SlabState* const s : {&before, static_cast<const SlabState*>(&slab), &after})
    for (const NodeState& n : s->node)
      std::copy_if(n.needed.begin(), n.needed.end(), std::back_inserter(needed),
                   [&](Vec3i c) { return c.x == slab.x; });
  if (needed.empty())
    return;
  par::sort_unique(needed, 1);
  for (const Vec3i& c : needed)
    slab.node.emplace_back().corner = c;
  std::sort(slab.node.begin(), slab.node.end(),
            [](const NodeState& a, const NodeState& b) { return a.corner < b.corner; });
}

void append(const SlabState& slab, Band& band, int threads) {
  const std::vector<Row> rows = rows_of(slab);
  const auto n = static_cast<int64_t>(rows.size()), parts = node_blocks * n; // by layer, then by row
  std::vector<int64_t> kept(static_cast<size_t>(parts)), closed(static_cast<size_t>(parts));
  for (int64_t p = 0; p < parts; ++p)
    for_runs(slab, rows[static_cast<size_t>(p % n)], static_cast<int>(p / n), [&](const NodeState& s, int first) {
      kept[static_cast<size_t>(p)] += std::popcount(run(s.kept, first));
      closed[static_cast<size_t>(p)] += std::popcount(run(s.closed, first));
    });
  const size_t blocks = band.block.size(), inside = band.inside.size();
  band.block.resize(blocks + static_cast<size_t>(par::exclusive_scan(kept)));
  band.inside.resize(inside + static_cast<size_t>(par::exclusive_scan(closed)));
  constexpr size_t at_once = 1024; // whose pages come together
  const size_t added = band.block.size() - blocks;
  par::for_n(static_cast<int64_t>((added + at_once - 1) / at_once), threads, 1, [&](int64_t p) {
    const size_t first = static_cast<size_t>(p) * at_once;
    prepare_pages(band.block.data() + blocks + first, std::min(at_once, added - first) * sizeof(BandBlock));
  });
  par::for_n(parts, threads, 1, [&](int64_t p) {
    BandBlock* block = band.block.data() + blocks + kept[static_cast<size_t>(p)];
    Vec3i* enclosed = band.inside.data() + inside + closed[static_cast<size_t>(p)];
    for_runs(slab, rows[static_cast<size_t>(p % n)], static_cast<int>(p / n), [&](const NodeState& s, int first) {
      const auto skipped = std::popcount(s.kept & ((uint64_t{1} << first) - 1));
      block = std::copy_n(s.band.begin() + skipped, std::popcount(run(s.kept, first)), block);
      for (int z = 0; z < node_blocks; ++z)
        if (s.closed >> (first + z) & 1)
          *enclosed++ = 8 * (s.corner + block_at(first + z));
    });
  });
}

} // namespace molmesh::density
