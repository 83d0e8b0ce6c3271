// node_mask.hpp — sets of octree nodes of one level, 4³ nodes a word. Host and device.
#pragma once
#include "base/bits.hpp"
#include "geom/morton.hpp"
#include "par/passes.hpp"

namespace molmesh::contour {

// Bit m of a word is the block's node at place m of the Z-order curve: node key = 64·block key + m.

/// Bits of the block's nodes at even places along the axis, and of those in its lower half.
MOLMESH_HD constexpr uint64_t even_nodes(int axis) {
  return axis == 0 ? 0x5555555555555555u : axis == 1 ? 0x3333333333333333u : 0x0F0F0F0F0F0F0F0Fu;
}
MOLMESH_HD constexpr uint64_t lower_nodes(int axis) {
  return axis == 0 ? 0x00FF00FF00FF00FFu : axis == 1 ? 0x0000FFFF0000FFFFu : 0x00000000FFFFFFFFu;
}
/// Bit n: the node after n along the axis is in the set; beyond: the next block's word.
MOLMESH_HD constexpr uint64_t with_next(uint64_t set, uint64_t beyond, int axis) {
  const uint64_t even = even_nodes(axis), low = lower_nodes(axis);
  const int s = 1 << axis;
  return (set >> s & even) | (set >> 7 * s & ~even & low) | (beyond << 9 * s & ~even & ~low);
}
/// Bit n: the node before n is.
MOLMESH_HD constexpr uint64_t with_previous(uint64_t set, uint64_t before, int axis) {
  const uint64_t even = even_nodes(axis), low = lower_nodes(axis);
  const int s = 1 << axis;
  return (set << s & ~even) | (set << 7 * s & even & ~low) | (before >> 9 * s & even & low);
}

/// Each bit of a byte eight times: nodes to their children.
MOLMESH_HD constexpr uint64_t eight_times(uint64_t byte) {
  byte = (byte | byte << 28) & 0x0000000F0000000Fu;
  byte = (byte | byte << 14) & 0x0003000300030003u;
  byte = (byte | byte << 7) & 0x0101010101010101u;
  return byte * 0xFF;
}

/// Nodes of the block that lie among the first `nodes` of each axis.
MOLMESH_HD inline uint64_t nodes_within(Vec3i block, Vec3i nodes) {
  const Vec3i left = nodes - 4 * block;
  if (left.x >= 4 && left.y >= 4 && left.z >= 4)
    return ~uint64_t{0};
  uint64_t in = 0;
  for (int m = 0; m < 64; ++m) {
    const Vec3i p = morton_point(static_cast<uint64_t>(m));
    in |= uint64_t{p.x < left.x && p.y < left.y && p.z < left.z} << m;
  }
  return in;
}

/// Nodes of a level that begin within the domain, an axis.
MOLMESH_HD inline Vec3i nodes_per_axis(Vec3i cells, int level) {
  const int32_t most = (1 << level) - 1;
  return {(cells.x + most) >> level, (cells.y + most) >> level, (cells.z + most) >> level};
}

/// Blocks by ascending key.
struct NodeSet {
  const par::KeyedWord* block;
  int64_t n;
  /// Position of a block, -1: no node of it is in the set.
  MOLMESH_HD int64_t find(uint64_t key) const {
    int64_t begin = 0, end = n;
    while (begin < end) {
      const int64_t middle = (begin + end) / 2;
      if (block[middle].key < key)
        begin = middle + 1;
      else
        end = middle;
    }
    return begin < n && block[begin].key == key ? begin : -1;
  }
  MOLMESH_HD uint64_t word(uint64_t key) const {
    const int64_t i = find(key);
    return i < 0 ? 0 : block[i].word;
  }
};

/// A box of blocks in any order.
struct BlockBox {
  Vec3i lower, size;
  MOLMESH_HD int64_t count() const { return int64_t{size.x} * size.y * size.z; }
  MOLMESH_HD Vec3i block(int64_t i) const {
    return lower + Vec3i{static_cast<int32_t>(i / size.z / size.y), static_cast<int32_t>(i / size.z % size.y),
                         static_cast<int32_t>(i % size.z)};
  }
};

} // namespace molmesh::contour
