// block_grid.hpp — the density on the grid points near the surface, in blocks of 8³; everything else is a side.
// What hier2density makes, the .vdb file holds and density2tet reads (design §2 and §3).
#pragma once
#include "density/large_array.hpp"
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
  HD Vec3d position(Vec3i p) const { return origin + spacing * to_double(p); }
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

/// Finds the block of a grid point: O(1), built in O(n). Keeps no reference to the grid.
class BlockIndex {
public:
  static constexpr int64_t outside = -1, inside = -2;
  explicit BlockIndex(const BlockGrid& grid);
  /// p: any index, also beyond the grid. ≥ 0: position in BlockGrid::corner.
  int64_t find(Vec3i p) const;

private:
  std::vector<Vec3i> key_;
  std::vector<int64_t> block_;
  uint64_t mask_ = 0;
};

/// Slot of p in BlockGrid::value within its block.
constexpr int slot(Vec3i p) {
  return (p.x & 7) << 6 | (p.y & 7) << 3 | (p.z & 7);
}
/// Lowest index of p's block (rounds down, also for negative indices).
constexpr Vec3i block_corner(Vec3i p) {
  return {p.x & ~7, p.y & ~7, p.z & ~7};
}

/// Value at any index: G if active, else 0 or inside_value.
float value_at(const BlockGrid& grid, const BlockIndex& index, Vec3i p);
bool is_active(const BlockGrid& grid, const BlockIndex& index, Vec3i p);

} // namespace molmesh
