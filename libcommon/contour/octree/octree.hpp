// octree.hpp — the index of a balanced linear octree: finds the leaf at a place, leaves along the Z-order curve.
// Section 4.1 of Liao et al. 2013. Neighbours across faces differ by one level at most, those across edges by two.
// leaf_passes.hpp finds the leaves.
#pragma once
#include "base/bits.hpp"
#include "base/large_array.hpp"
#include "geom/morton.hpp"
#include "geom/vec.hpp"
#include <cstdint>

namespace molmesh::contour {

/// An octree as plain arrays. Host and device.
struct OctreeView {
  struct Block { ///< 8³ fine cells that hold leaves below level 3
    uint64_t key;
    int32_t first;     ///< first leaf
    uint64_t start[8]; ///< bit m: a leaf starts at Morton position m within the block
    uint16_t rank[8];  ///< leaves that start in the words before
    MOLMESH_HD int32_t leaf(uint64_t k) const {
      const auto word = static_cast<unsigned>(k >> 6 & 7);
      return first + rank[word] + count_bits(start[word] & (~uint64_t{0} >> (63 - (k & 63)))) - 1;
    }
  };
  const uint64_t* key = nullptr;  ///< [leaves] ascending; Morton code of the lower corner
  const uint8_t* level = nullptr; ///< [leaves] 0: fine cell
  int32_t leaves = 0;
  Vec3i cells;
  uint64_t end[3] = {}; ///< Morton codes of the cells along each axis
  const Block* block = nullptr;
  const uint32_t* slot = nullptr; ///< [mask + 1] open addressing: blocks, and of_large + leaf for larger leaves
  uint64_t mask = 0;
  const int32_t* large = nullptr; ///< [large_leaves] leaves of level 3 and more, ascending
  int32_t large_leaves = 0;

  static constexpr uint32_t free_slot = ~uint32_t{0}, of_large = uint32_t{1} << 31;

  MOLMESH_HD int32_t size() const { return leaves; }
  MOLMESH_HD Vec3i corner(int32_t leaf) const { return morton_point(key[leaf]); } ///< lower corner, lattice point
  MOLMESH_HD int32_t extent(int32_t leaf) const { return 1 << level[leaf]; }      ///< fine cells along an edge
  /// Whether the fine cell of Morton code k, reached from the domain, lies before its end along the axis.
  MOLMESH_HD bool before_end(uint64_t k, int axis) const { return (k & morton_axis(axis)) < end[axis]; }
  /// Moves k, the lower corner of a leaf as far as this axis goes, to the cell beyond the leaf's lower or upper
  /// side; false where there is none.
  MOLMESH_HD bool beyond(uint64_t& k, int of_level, int axis, bool upper) const {
    if (!upper && (k & morton_axis(axis)) == 0)
      return false;
    k = upper ? morton_after(k, axis, of_level) : morton_before(k, axis);
    return !upper || before_end(k, axis);
  }
  MOLMESH_HD bool holds(Vec3i p) const {
    return !(p.x < 0 || p.y < 0 || p.z < 0 || p.x >= cells.x || p.y >= cells.y || p.z >= cells.z);
  }
  /// The leaf that holds fine cell p, or -1 beyond the domain.
  MOLMESH_HD int32_t find(Vec3i p) const { return holds(p) ? find_key(morton(p)) : -1; }
  /// The leaf that holds the fine cell of Morton code k, which lies in the domain.
  MOLMESH_HD int32_t find_key(uint64_t k) const { return leaf_in(find_entry(k), k); }
  /// Of what holds k, block or large leaf: as find_key.
  MOLMESH_HD int32_t leaf_in(uint32_t entry, uint64_t k) const {
    return entry < of_large ? block[entry].leaf(k) : static_cast<int32_t>(entry - of_large);
  }
  /// The leaf whose lower corner is k; -1: none.
  MOLMESH_HD int32_t starting_in(uint32_t entry, uint64_t k) const {
    if (entry < of_large)
      return block[entry].start[k >> 6 & 7] >> (k & 63) & 1 ? block[entry].leaf(k) : -1;
    const auto leaf = static_cast<int32_t>(entry - of_large);
    return key[leaf] == k ? leaf : -1;
  }
  /// The block or large leaf that holds the fine cell of Morton code k, which lies in the domain.
  MOLMESH_HD uint32_t find_entry(uint64_t k) const {
    // A node of a higher level where anything starts is the leaf: those with children have been looked at.
    constexpr int most_level = 20;
    uint32_t entry = starting_entry(k >> 9);
    for (int l = 4; entry == free_slot && l <= most_level; ++l)
      entry = starting_entry(k >> 3 * l << (3 * l - 9));
    return entry;
  }
  MOLMESH_HD static uint64_t mix(uint64_t k) {
    k *= 0x9E3779B97F4A7C15u;
    return k ^ k >> 32;
  }
  /// Of what a slot holds: the Morton code of its lower corner / 8³.
  MOLMESH_HD uint64_t entry_key(uint32_t entry) const {
    return entry < of_large ? block[entry].key : key[entry - of_large] >> 9;
  }

private:
  /// What starts at block k, free_slot where nothing does.
  MOLMESH_HD uint32_t starting_entry(uint64_t k) const {
    uint64_t s = mix(k) & mask;
    while (slot[s] != free_slot && entry_key(slot[s]) != k)
      s = (s + 1) & mask;
    return slot[s];
  }
};

/// Finds leaves close to each other: what held the last ones is known. Blocks side by side differ in the parity of
/// their places, which says where they are kept.
class NearLeaves {
public:
  MOLMESH_HD explicit NearLeaves(const OctreeView& tree) : tree_(tree) {
    for (uint64_t& b : block_)
      b = ~uint64_t{0};
  }
  MOLMESH_HD const OctreeView& tree() const { return tree_; }
  /// As the tree's.
  MOLMESH_HD int32_t find_key(uint64_t k) { return tree_.leaf_in(entry_of(k), k); }
  MOLMESH_HD int32_t find(Vec3i p) { return tree_.holds(p) ? find_key(morton(p)) : -1; }
  /// The leaf whose lower corner is the fine cell of Morton code k, which lies in the domain; -1: none.
  MOLMESH_HD int32_t starting_at(uint64_t k) { return tree_.starting_in(entry_of(k), k); }
  /// The first leaf across face 2 · axis + upper, -1 at a wall. Where it is smaller, so are all along the face.
  MOLMESH_HD int32_t neighbour(int32_t leaf, int face) {
    uint64_t k = tree_.key[leaf];
    return tree_.beyond(k, tree_.level[leaf], face / 2, face % 2) ? find_key(k) : -1;
  }

private:
  MOLMESH_HD uint32_t entry_of(uint64_t k) {
    const uint64_t at = k >> 9 & 7;
    if (block_[at] != k >> 9) {
      block_[at] = k >> 9;
      entry_[at] = tree_.find_entry(k);
    }
    return entry_[at];
  }
  const OctreeView& tree_;
  uint64_t block_[8];
  uint32_t entry_[8] = {};
};

inline constexpr int64_t most_leaves = int64_t{1} << 28; ///< their corners are numbered in 31 bits

/// What OctreeView points to, but for the hash.
struct LeafList {
  LargeArray<uint64_t> key;
  LargeArray<uint8_t> level;
  LargeArray<OctreeView::Block> block; ///< ascending
  LargeArray<int32_t> large;           ///< ascending
  double adapt = 0;                    ///< the tolerance that chords allowed, in fine spacings
};

class Octree {
public:
  /// cells: size of the domain in fine cells; leaves never reach beyond it.
  Octree(Vec3i cells, LeafList leaves, int threads = 1);
  Octree(const Octree&) = delete;
  Octree& operator=(const Octree&) = delete;

  int32_t size() const { return view_.leaves; }
  /// The leaf that holds fine cell p, or -1 beyond the domain.
  int32_t find(Vec3i p) const { return view_.find(p); }
  Vec3i corner(int32_t leaf) const { return view_.corner(leaf); } ///< lower corner, lattice point
  int32_t extent(int32_t leaf) const { return view_.extent(leaf); }
  /// Points into the tree.
  const OctreeView& view() const { return view_; }

  const LargeArray<uint64_t> key;  ///< ascending; Morton code of the lower corner
  const LargeArray<uint8_t> level; ///< 0: fine cell

private:
  LargeArray<OctreeView::Block> block_;
  LargeArray<int32_t> large_;
  LargeArray<uint32_t> slot_;
  OctreeView view_;
};

} // namespace molmesh::contour
