// band_items.hpp — tells which blocks the band needs and which points are in it, and packs them.
#pragma once
#include "cuda/density/block_key.hpp"

namespace molmesh::cuda {

/// What is known of the grid: blocks in ascending order, each with the bits of its points below and above the band
/// (16 words); value null where a bound alone says the side. Blocks that are not here are below the band.
struct KnownView {
  const Key* key;
  const uint64_t* const* mask;
  const float* const* value;
  int64_t n;
  const uint64_t* below; ///< the mask of a block that is not here

  MOLMESH_HD const uint64_t* mask_at(Vec3i b) const {
    const int64_t i = find_key(key, n, BlockFrame::key(b));
    return i < 0 ? below : mask[i];
  }
};

/// Bits of the points of a block's word i (its plane x = i) that face neighbour n.
MOLMESH_HD inline uint64_t facing(int n, int i) {
  const int dx = n / 9 - 1, dy = n / 3 % 3 - 1, dz = n % 3 - 1;
  if (dx != 0 && i != (dx < 0 ? 0 : 7))
    return 0;
  const uint64_t rows = dy == 0 ? ~uint64_t{0} : uint64_t{0xFF} << (dy < 0 ? 0 : 56);
  const uint64_t columns = dz == 0 ? ~uint64_t{0} : uint64_t{0x0101010101010101} << (dz < 0 ? 0 : 7);
  return rows & columns;
}

/// Next to block i, the blocks without values that have a corner of a band cell: where the layer that faces them is
/// not wholly on their side. count[i] of them, or with `out` the keys from out[count[i]] on.
struct MissingNeighbors {
  KnownView known;
  BlockFrame frame;
  int32_t begin_x, end_x; ///< only those with begin_x ≤ x < end_x are wanted
  int64_t* count;
  Key* out;

  MOLMESH_HD void operator()(int64_t i) const {
    const Vec3i b = BlockFrame::block(known.key[i]);
    int64_t found = 0;
    const auto want = [&](Vec3i c) {
      if (!frame.holds(c) || c.x < begin_x || c.x >= end_x)
        return;
      if (out)
        out[count[i] + found] = BlockFrame::key(c);
      ++found;
    };
    const uint64_t* const own = known.mask[i];
    const bool has_values = known.value[i] != nullptr;
    for (int n = 0; n < 27; ++n) {
      const Vec3i c = neighbor(b, n);
      if (n == 13 || !frame.holds(c))
        continue;
      const int64_t at = find_key(known.key, known.n, BlockFrame::key(c));
      if (at >= 0 && known.value[at])
        continue;
      const bool is_above = at >= 0 && (known.mask[at][8] & 1);
      uint64_t left = 0; // points of the layer that are not on c's side
      for (int w = 0; w < 8; ++w)
        left |= facing(n, w) & ~own[is_above ? 8 + w : w];
      if (left == 0)
        continue;
      want(c);
      if (!has_values) // opposite sides next to each other: both
        want(b);
    }
    if (!out)
      count[i] = found;
  }
};

/// Corners of band cells among the points of block first + i: a cell is one when its corners are neither all below
/// nor all above. Cells that reach beyond the grid are none. Sets active[8·i …], and how many there are.
struct ActivePoints {
  KnownView known;
  BlockFrame frame;
  int64_t first;
  uint64_t* active;
  int64_t* points; ///< count of i
  int64_t* blocks; ///< 1 when there are any

  MOLMESH_HD void operator()(int64_t i) const {
    uint64_t* const out = active + 8 * i;
    for (int w = 0; w < 8; ++w)
      out[w] = 0;
    points[i] = blocks[i] = 0;
    if (!known.value[first + i])
      return;
    const Vec3i b = BlockFrame::block(known.key[first + i]), corner = frame.corner(b);
    const uint64_t* mask[27];
    for (int n = 0; n < 27; ++n)
      mask[n] = n == 13 ? known.mask[first + i] : known.mask_at(neighbor(b, n));
    const Vec3i low = frame.grid.lower, last = low + frame.grid.points - Vec3i{1, 1, 1};
    const auto cells_along = [&](int axis) { // bit i: the cell between points i - 1 and i lies in the grid
      uint32_t in = 0;
      for (int k = 0; k < 9; ++k)
        in |= uint32_t{corner[axis] + k - 1 >= low[axis] && corner[axis] + k - 1 < last[axis]} << k;
      return in;
    };
    const uint32_t in_x = cells_along(0), in_y = cells_along(1), in_z = cells_along(2);
    // Rows of ten bits along z: points -1 … 8 of row (x, y), below or above.
    const auto row = [&](int side, int x, int y) {
      const int word = 8 * side + (x + 8) % 8, shift = 8 * ((y + 8) % 8);
      const uint64_t* const* m = mask + 9 * ((x + 8) / 8) + 3 * ((y + 8) / 8);
      return uint32_t(m[0][word] >> shift >> 7 & 1) | uint32_t(m[1][word] >> shift & 0xFF) << 1 |
             uint32_t(m[2][word] >> shift & 1) << 9;
    };
    uint32_t plane[2][2][10]; // of x - 1 and x: side, row
    uint32_t before[9] = {};  // band cells between the planes before
    for (int x = -1; x < 9; ++x) {
      uint32_t cell[9];
      for (int side = 0; side < 2; ++side)
        for (int y = -1; y < 9; ++y)
          plane[(x + 1) & 1][side][y + 1] = row(side, x, y);
      if (x < 0)
        continue;
      for (int y = 0; y < 9; ++y) {
        uint32_t one_sided = 0;
        for (int side = 0; side < 2; ++side) {
          const uint32_t four =
              plane[0][side][y] & plane[0][side][y + 1] & plane[1][side][y] & plane[1][side][y + 1];
          one_sided |= four & four >> 1;
        }
        cell[y] = in_x >> x & in_y >> y & 1 ? ~one_sided & in_z : 0;
      }
      if (x > 0)
        for (int y = 0; y < 8; ++y) {
          const uint32_t four = before[y] | before[y + 1] | cell[y] | cell[y + 1];
          out[x - 1] |= uint64_t{(four | four >> 1) & 0xFF} << 8 * y;
        }
      for (int y = 0; y < 9; ++y)
        before[y] = cell[y];
    }
    for (int w = 0; w < 8; ++w)
      for (uint64_t bits = out[w]; bits; bits &= bits - 1)
        ++points[i];
    blocks[i] = points[i] > 0;
  }
};

/// Blocks with active points one after the other: their bits, sides and values in order.
struct PackBand {
  KnownView known;
  int64_t first;
  const uint64_t* active;
  const int64_t *point, *block; ///< scanned counts
  Key* key;
  uint64_t* bits; ///< [16 blocks] active, above
  float* packed;

  MOLMESH_HD void operator()(int64_t i) const {
    if (block[i + 1] == block[i])
      return;
    key[block[i]] = known.key[first + i];
    uint64_t* const to = bits + 16 * block[i];
    float* v = packed + point[i];
    for (int w = 0; w < 8; ++w) {
      to[w] = active[8 * i + w];
      to[8 + w] = known.mask[first + i][8 + w];
      for (int s = 0; s < 64; ++s)
        if (to[w] >> s & 1)
          *v++ = known.value[first + i][64 * w + s];
    }
  }
};

/// Blocks without active points that lie above the band: count[i] = 1, or with `out` their keys.
struct InsideBlocks {
  KnownView known;
  int64_t first;
  const int64_t* has_points; ///< scanned
  int64_t* count;
  Key* out;

  MOLMESH_HD void operator()(int64_t i) const {
    const bool inside = has_points[i + 1] == has_points[i] && (known.mask[first + i][8] & 1);
    if (!out)
      count[i] = inside;
    else if (inside)
      out[count[i]] = known.key[first + i];
  }
};

} // namespace molmesh::cuda
