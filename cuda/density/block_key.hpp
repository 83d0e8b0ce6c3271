// block_key.hpp — blocks of 8³ grid points as numbers that sort as (x, y, z) do; neighbours by bisection.
#pragma once
#include "base/hd.hpp"
#include "density/field/field.hpp"
#include "grid/block_grid.hpp"

namespace molmesh::cuda {

using Key = uint64_t;
inline constexpr int key_bits = 21; ///< of an axis
inline constexpr Key no_key = ~Key{0};

/// The grid in blocks, counted from the lowest.
struct BlockFrame {
  GridFrame grid;
  Vec3i first;  ///< block that holds the grid's lowest point; block b's lowest index is 8·(first + b)
  Vec3i blocks; ///< per axis

  MOLMESH_HD static Key key(Vec3i b) {
    return Key(uint32_t(b.x)) << 2 * key_bits | Key(uint32_t(b.y)) << key_bits | Key(uint32_t(b.z));
  }
  MOLMESH_HD static Vec3i block(Key k) {
    constexpr Key mask = (Key{1} << key_bits) - 1;
    return {int32_t(k >> 2 * key_bits), int32_t(k >> key_bits & mask), int32_t(k & mask)};
  }
  MOLMESH_HD bool holds(Vec3i b) const {
    return b.x >= 0 && b.y >= 0 && b.z >= 0 && b.x < blocks.x && b.y < blocks.y && b.z < blocks.z;
  }
  MOLMESH_HD Vec3i corner(Vec3i b) const { return 8 * (first + b); }
  /// Of the points of a cube of blocks, Å.
  MOLMESH_HD density::Box box(Vec3i b, int32_t edge) const {
    const Vec3i low = corner(b);
    return {grid.position(low), grid.position(low + Vec3i{1, 1, 1} * (8 * edge - 1))};
  }
};

/// Position of `k` among n ascending keys, or -1.
MOLMESH_HD inline int64_t find_key(const Key* keys, int64_t n, Key k) {
  int64_t begin = 0, end = n;
  while (begin < end) {
    const int64_t middle = (begin + end) / 2;
    if (keys[middle] < k)
      begin = middle + 1;
    else
      end = middle;
  }
  return begin < n && keys[begin] == k ? begin : -1;
}

/// Neighbour n of 27: steps of -1, 0, 1 along x, y, z, z fastest.
MOLMESH_HD inline Vec3i neighbor(Vec3i b, int n) {
  return b + Vec3i{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
}

} // namespace molmesh::cuda
