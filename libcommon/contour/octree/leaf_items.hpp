// leaf_items.hpp — kernels that make leaves of the nodes that have children: large ones, and blocks of 8³ fine
// cells. Host and device.
#pragma once
#include "contour/octree/node_mask.hpp"
#include "contour/octree/octree.hpp"

namespace molmesh::contour {

/// Leaves and blocks by the Morton key of their lower corner; word: the leaf's level, or this.
inline constexpr uint64_t is_block = 0;

MOLMESH_HD inline int64_t add_nodes(uint64_t block, uint64_t nodes, int level, uint64_t word, par::KeyedWord* out) {
  for (uint64_t rest = nodes; out && rest; rest &= rest - 1)
    *out++ = {(block << 6 | static_cast<uint64_t>(lowest_bit(rest))) << 3 * level, word};
  return count_bits(nodes);
}

/// Nodes of the top level without children. Block i of a box.
struct LeafRoots {
  BlockBox box;
  Vec3i nodes; ///< of the level, per axis
  NodeSet refined;
  int level;
  MOLMESH_HD int64_t operator()(int64_t i, par::KeyedWord* out) const {
    const uint64_t key = morton(box.block(i));
    return add_nodes(key, nodes_within(box.block(i), nodes) & ~refined.word(key), level, uint64_t(level), out);
  }
};

/// Children of eight siblings (i % 8 of block i / 8) that have none themselves. level: theirs
struct LeafChildren {
  NodeSet parents, refined;
  Vec3i nodes;
  int level;
  MOLMESH_HD int64_t operator()(int64_t i, par::KeyedWord* out) const {
    const uint64_t siblings = parents.block[i >> 3].word >> 8 * (i & 7) & 0xFF;
    if (siblings == 0)
      return 0;
    const uint64_t key = parents.block[i >> 3].key << 3 | static_cast<uint64_t>(i & 7);
    return add_nodes(key, eight_times(siblings) & nodes_within(morton_point(key), nodes) & ~refined.word(key),
                     level, uint64_t(level), out);
  }
};

/// Blocks of 8³ fine cells: nodes of level 3 with children.
struct LeafBlocks {
  NodeSet refined;
  MOLMESH_HD int64_t operator()(int64_t i, par::KeyedWord* out) const {
    return add_nodes(refined.block[i].key, refined.block[i].word, 3, is_block, out);
  }
};

/// Where leaves of levels 0, 1 and 2 start within the block of fine cell `key`, by the nodes of levels 1 and 2 with
/// children.
MOLMESH_HD inline void leaf_starts(uint64_t key, NodeSet level1, NodeSet level2, Vec3i cells, uint64_t start[8]) {
  const uint64_t fine = level1.word(key >> 9), middle = level2.word(key >> 12) >> 8 * (key >> 9 & 7);
  const Vec3i left = cells - morton_point(key);
  for (int w = 0; w < 8; ++w) {
    start[w] = 1;
    if (middle >> w & 1)
      start[w] = 0x0101010101010101u | eight_times(fine >> 8 * w & 0xFF);
    if (left.x >= 8 && left.y >= 8 && left.z >= 8)
      continue;
    for (uint64_t rest = start[w]; rest; rest &= rest - 1) {
      const Vec3i p = morton_point(uint64_t(w) << 6 | uint64_t(lowest_bit(rest)));
      if (p.x >= left.x || p.y >= left.y || p.z >= left.z)
        start[w] ^= rest & ~(rest - 1);
    }
  }
}

/// Entry i of the sorted blocks and large leaves: how many leaves and blocks it is.
struct CountLeaves {
  const par::KeyedWord* entry;
  NodeSet level1, level2;
  Vec3i cells;
  int64_t *leaves, *blocks;
  MOLMESH_HD void operator()(int64_t i) const {
    blocks[i] = entry[i].word == is_block;
    leaves[i] = 1;
    if (!blocks[i])
      return;
    uint64_t start[8];
    leaf_starts(entry[i].key, level1, level2, cells, start);
    leaves[i] = 0;
    for (uint64_t s : start)
      leaves[i] += count_bits(s);
  }
};
struct PlaceLeaves {
  CountLeaves entries; ///< counts scanned
  OctreeView::Block* block;
  int32_t* large; ///< leaves of level 3 and more
  uint64_t* key;
  uint8_t* level;
  MOLMESH_HD void operator()(int64_t i) const {
    const par::KeyedWord e = entries.entry[i];
    const int64_t first = entries.leaves[i], b = entries.blocks[i];
    if (e.word != is_block) {
      large[i - b] = static_cast<int32_t>(first);
      key[first] = e.key;
      level[first] = static_cast<uint8_t>(e.word);
      return;
    }
    OctreeView::Block& out = block[b];
    out.key = e.key >> 9;
    out.first = static_cast<int32_t>(first);
    leaf_starts(e.key, entries.level1, entries.level2, entries.cells, out.start);
    int rank = 0;
    for (int w = 0; w < 8; ++w) {
      out.rank[w] = static_cast<uint16_t>(rank);
      rank += count_bits(out.start[w]);
    }
  }
};
/// Word i % 8 of block i / 8.
struct FillBlocks {
  const OctreeView::Block* block;
  NodeSet level1, level2;
  uint64_t* key;
  uint8_t* level;
  MOLMESH_HD void operator()(int64_t i) const {
    const OctreeView::Block& b = block[i >> 3];
    const auto w = static_cast<uint64_t>(i & 7);
    if (b.start[w] == 0)
      return;
    const uint64_t fine = level1.word(b.key) >> 8 * w;
    const bool middle = level2.word(b.key >> 3) >> (8 * (b.key & 7) + w) & 1;
    int64_t at = b.first + b.rank[w];
    for (uint64_t bits = b.start[w]; bits; bits &= bits - 1, ++at) {
      const int m = lowest_bit(bits);
      key[at] = b.key << 9 | w << 6 | static_cast<uint64_t>(m);
      level[at] = !middle ? uint8_t{2} : fine >> (m >> 3) & 1 ? uint8_t{0} : uint8_t{1};
    }
  }
};

} // namespace molmesh::contour
