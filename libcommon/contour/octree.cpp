// octree.cpp — balancing from the fine level up, then one walk along the curve.
#include "contour/octree.hpp"
#include "geom/morton.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>

namespace molmesh::contour {
namespace {

/// std::popcount is a call into a table where the processor's own instruction may not be assumed.
int popcount(uint64_t x) {
  x -= x >> 1 & 0x5555555555555555u;
  x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
  x = (x + (x >> 4)) & 0x0F0F0F0F0F0F0F0Fu;
  return static_cast<int>(x * 0x0101010101010101u >> 56);
}

uint64_t mix(uint64_t key) {
  key *= 0x9E3779B97F4A7C15u;
  return key ^ key >> 32;
}

/// Walks below one node; `next` holds, per level, the position in refined[level] that the walk has reached.
struct Walk {
  const std::vector<std::vector<uint64_t>>& refined;
  Vec3i cells;
  std::vector<size_t> next;
  std::vector<uint64_t> key;
  std::vector<uint8_t> level;

  void visit(uint64_t node, int l) {
    const Vec3i corner = morton_point(node << 3 * l);
    if (corner.x >= cells.x || corner.y >= cells.y || corner.z >= cells.z)
      return;
    size_t& n = next[static_cast<size_t>(l)];
    const std::vector<uint64_t>& r = refined[static_cast<size_t>(l)];
    if (l > 0 && n < r.size() && r[n] == node) {
      ++n;
      for (uint64_t child = 0; child < 8; ++child)
        visit(node << 3 | child, l - 1);
      return;
    }
    key.push_back(node << 3 * l);
    level.push_back(static_cast<uint8_t>(l));
  }
};

/// Parents of the 26 neighbours of every node of `nodes` (sorted) and their own, appended to `out`.
void append_parents_of_neighbours(const std::vector<uint64_t>& nodes, Vec3i nodes_per_axis,
                                  std::vector<uint64_t>& out) {
  for (size_t i = 0; i < nodes.size();) {
    // Siblings stand together: gather which neighbours of their parent they touch.
    const uint64_t parent = nodes[i] >> 3;
    uint32_t touched = 0; // bit 9 (dx + 1) + 3 (dy + 1) + dz + 1
    for (; i < nodes.size() && nodes[i] >> 3 == parent; ++i) {
      const int at[3] = {int(nodes[i] & 1), int(nodes[i] >> 1 & 1), int(nodes[i] >> 2 & 1)};
      for (int n = 0; n < 8; ++n) {
        const auto step = [&](int a) { return n >> a & 1 ? (at[a] ? 1 : -1) : 0; };
        touched |= 1u << (9 * (step(0) + 1) + 3 * (step(1) + 1) + step(2) + 1);
      }
    }
    const Vec3i p = morton_point(parent);
    for (int n = 0; n < 27; ++n) {
      if (!(touched >> n & 1))
        continue;
      const Vec3i q = p + Vec3i{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
      if (q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < nodes_per_axis.x && q.y < nodes_per_axis.y &&
          q.z < nodes_per_axis.z)
        out.push_back(morton(q));
    }
  }
}

} // namespace

Octree::Octree(Vec3i cells, int top_level, const Refine& refine, int threads) : cells_(cells) {
  std::vector<std::vector<uint64_t>> refined(static_cast<size_t>(top_level) + 1); // per level, ascending
  const auto nodes_per_axis = [&](int l) {
    const auto up = [&](int32_t n) { return (n + (1 << l) - 1) >> l; };
    return Vec3i{up(cells.x), up(cells.y), up(cells.z)};
  };
  for (int l = 1; l <= top_level; ++l) {
    std::vector<uint64_t>& here = refined[static_cast<size_t>(l)];
    // Nodes that reach beyond the domain have children.
    const Vec3i n = nodes_per_axis(l);
    for (int a = 0; a < 3; ++a) {
      if (cells[a] % (1 << l) == 0)
        continue;
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      Vec3i p;
      p[a] = n[a] - 1;
      for (p[b] = 0; p[b] < n[b]; ++p[b])
        for (p[c] = 0; p[c] < n[c]; ++p[c])
          here.push_back(morton(p));
    }
    par::sort_unique(here, threads);
    refine(l, here);
    par::sort_unique(here, threads);
    if (l < top_level)
      append_parents_of_neighbours(here, nodes_per_axis(l + 1), refined[static_cast<size_t>(l) + 1]);
  }
  // One walk per root, roots along the curve.
  const Vec3i n = nodes_per_axis(top_level);
  std::vector<uint64_t> root;
  for (int32_t x = 0; x < n.x; ++x)
    for (int32_t y = 0; y < n.y; ++y)
      for (int32_t z = 0; z < n.z; ++z)
        root.push_back(morton({x, y, z}));
  std::sort(root.begin(), root.end());
  std::vector<Walk> walk(root.size(), Walk{refined, cells, {}, {}, {}});
  par::for_n(static_cast<int64_t>(root.size()), threads, 1, [&](int64_t i) {
    Walk& w = walk[static_cast<size_t>(i)];
    const uint64_t node = root[static_cast<size_t>(i)];
    for (int l = 0; l <= top_level; ++l) {
      const std::vector<uint64_t>& r = refined[static_cast<size_t>(l)];
      w.next.push_back(
          static_cast<size_t>(std::lower_bound(r.begin(), r.end(), node << 3 * (top_level - l)) - r.begin()));
    }
    w.visit(node, top_level);
  });
  size_t total = 0;
  for (const Walk& w : walk)
    total += w.key.size();
  key.reserve(total);
  level.reserve(total);
  for (Walk& w : walk) {
    key.insert(key.end(), w.key.begin(), w.key.end());
    level.insert(level.end(), w.level.begin(), w.level.end());
    std::vector<uint64_t>().swap(w.key);
    std::vector<uint8_t>().swap(w.level);
  }
  index_leaves();
}

void Octree::index_leaves() {
  corner_.resize(key.size());
  for (size_t i = 0; i < key.size(); ++i)
    corner_[i] = morton_point(key[i]);
  for (int32_t i = 0; i < size(); ++i) {
    const uint64_t k = key[static_cast<size_t>(i)];
    if (level[static_cast<size_t>(i)] >= 3) {
      large_.push_back(i);
      continue;
    }
    if (block_.empty() || block_.back().key != k >> 9)
      block_.push_back({k >> 9, i, {}, {}});
    block_.back().start[k >> 6 & 7] |= uint64_t{1} << (k & 63);
  }
  for (Block& b : block_)
    for (size_t w = 1; w < 8; ++w)
      b.rank[w] = static_cast<uint16_t>(b.rank[w - 1] + std::popcount(b.start[w - 1]));
  uint64_t capacity = 16;
  while (capacity < 2 * block_.size())
    capacity *= 2;
  mask_ = capacity - 1;
  slot_.assign(capacity, -1);
  for (size_t b = 0; b < block_.size(); ++b) {
    uint64_t s = mix(block_[b].key) & mask_;
    while (slot_[s] >= 0)
      s = (s + 1) & mask_;
    slot_[s] = static_cast<int32_t>(b);
  }
}

int32_t Octree::find(Vec3i p) const {
  if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= cells_.x || p.y >= cells_.y || p.z >= cells_.z)
    return -1;
  const uint64_t k = morton(p);
  for (uint64_t s = mix(k >> 9) & mask_; slot_[s] >= 0; s = (s + 1) & mask_) {
    const Block& block = block_[static_cast<size_t>(slot_[s])];
    if (block.key != k >> 9)
      continue;
    const unsigned word = k >> 6 & 7;
    return block.first + block.rank[word] + popcount(block.start[word] & (~uint64_t{0} >> (63 - (k & 63)))) - 1;
  }
  const auto after = std::upper_bound(large_.begin(), large_.end(), k, [this](uint64_t x, int32_t leaf) {
    return x < key[static_cast<size_t>(leaf)];
  });
  return *(after - 1);
}

} // namespace molmesh::contour
