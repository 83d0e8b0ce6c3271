// block_grid.hpp — the density on the grid points near the surface, in blocks of 8³; all other points have a side
// alone. What hier2density makes, the .vdb file holds and density2tet reads (docs/conventions.md).
#pragma once
#include "base/large_array.hpp"
#include "geom/vec.hpp"
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace molmesh {

/// Grid point (i,j,k) lies at origin + spacing·(i,j,k). The full rectilinear grid is the box of points
/// lower … lower + points - 1, in index space.
struct GridFrame {
  Vec3d origin;       ///< Å, position of index (0,0,0)
  double spacing = 0; ///< h, Å
  Vec3i lower;        ///< lowest index of the grid
  Vec3i points;       ///< nx, ny, nz
  MOLMESH_HD Vec3d position(Vec3i p) const { return origin + spacing * to_double(p); }
  /// Of the block of 8³ points from `corner` on, which meets the grid.
  MOLMESH_HD int64_t points_of_block(Vec3i corner) const {
    int64_t n = 1;
    for (int a = 0; a < 3; ++a) {
      const int32_t begin = corner[a] > lower[a] ? corner[a] : lower[a], end = lower[a] + points[a];
      n *= (corner[a] + 8 < end ? corner[a] + 8 : end) - begin;
    }
    return n;
  }
};

/// The grid metadata of the .vdb file.
struct FieldInfo {
  double isovalue = 1, decay = 1; ///< G (no unit), κ in Å⁻²
  double band_lower = 0.9, band_upper = 1.1;
  double tolerance = 1e-4;     ///< ε of I1
  double inside_value = 2;     ///< what inactive inside points hold; > isovalue
  int64_t analyzed_points = 0; ///< points whose density was computed: k_A · nx·ny·nz
  int64_t atoms = 0;
  std::string levels; ///< "chain residue", may be empty
  std::string source;
  std::string creator; ///< "hier2density 0.1.0"
};

/// Active points are the corners of every band cell and hold G. Inactive points hold 0 outside, inside_value
/// inside.
struct BlockGrid {
  GridFrame frame;
  FieldInfo info;

  /// corner [n]        lowest index of each block that has an active point; multiples of 8, ascending (x, y, z)
  /// value  [512 n]    slot = 512·b + 64·i + 8·j + k, OpenVDB's leaf order; inactive slots hold their side's value
  /// active [8 n]      word 8·b + i, bit 8·j + k
  /// inside [m]        corners of the blocks without active points that lie wholly inside, ascending
  std::vector<Vec3i> corner;
  LargeArray<float> value;
  LargeArray<uint64_t> active;
  std::vector<Vec3i> inside;
};

/// Slot of p in BlockGrid::value within its block.
MOLMESH_HD constexpr int slot(Vec3i p) {
  return (p.x & 7) << 6 | (p.y & 7) << 3 | (p.z & 7);
}
/// From the block's corner to the point of that slot.
MOLMESH_HD constexpr Vec3i within_block(int slot) {
  return {slot >> 6, slot >> 3 & 7, slot & 7};
}
/// Lowest index of p's block (rounds down, also for negative indices).
MOLMESH_HD constexpr Vec3i block_corner(Vec3i p) {
  return {p.x & ~7, p.y & ~7, p.z & ~7};
}

/// The hash of a BlockIndex as plain arrays: open addressing, at most half full.
struct BlockIndexView {
  static constexpr int64_t outside = -1, inside = -2;
  const Vec3i* key;
  const int64_t* block;
  uint64_t mask;

  MOLMESH_HD static uint64_t hash(Vec3i corner) {
    const auto u = [](int32_t c) { return static_cast<uint64_t>(static_cast<uint32_t>(c >> 3)); };
    uint64_t h =
        u(corner.x) * 0x9E3779B97F4A7C15u ^ u(corner.y) * 0xC2B2AE3D27D4EB4Fu ^ u(corner.z) * 0x165667B19E3779F9u;
    return h ^ (h >> 29);
  }
  /// p: any index, also beyond the grid. ≥ 0: position in BlockGrid::corner.
  MOLMESH_HD int64_t find(Vec3i p) const {
    const Vec3i corner = block_corner(p);
    for (uint64_t i = hash(corner) & mask; block[i] != outside; i = (i + 1) & mask)
      if (key[i] == corner)
        return block[i];
    return outside;
  }
  /// The block found last: asking for it again costs nothing.
  struct Last {
    Vec3i corner{1, 1, 1}; ///< no block's
    int64_t block = outside;
  };
  MOLMESH_HD int64_t find(Vec3i p, Last& last) const {
    if (const Vec3i corner = block_corner(p); !(corner == last.corner))
      last = {corner, find(p)};
    return last.block;
  }
};

/// Finds the block of a grid point: O(1), built in O(n). Keeps no reference to the grid.
class BlockIndex {
public:
  static constexpr int64_t outside = BlockIndexView::outside, inside = BlockIndexView::inside;
  explicit BlockIndex(const BlockGrid& grid);
  int64_t find(Vec3i p) const { return view().find(p); }
  BlockIndexView view() const { return {key_.data(), block_.data(), mask_}; }
  int64_t capacity() const { return static_cast<int64_t>(key_.size()); }

private:
  std::vector<Vec3i> key_;
  std::vector<int64_t> block_;
  uint64_t mask_ = 0;
};

/// Value at any index: G if active, else 0 or inside_value.
float value_at(const BlockGrid& grid, const BlockIndex& index, Vec3i p);
bool is_active(const BlockGrid& grid, const BlockIndex& index, Vec3i p);

} // namespace molmesh
