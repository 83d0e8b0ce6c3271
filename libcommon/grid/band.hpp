// band.hpp — the band, packed: what the neighboring search finds and the file holds.
// A cell is a band cell when its corners are neither all below band_lower nor all above band_upper.
#pragma once
#include "grid/block_grid.hpp"
#include <array>
#include <span>

namespace molmesh {

/// 8³ points: bit 8·j + k of word i.
using Mask = std::array<uint64_t, 8>;

/// A block with active points. Few inactive points are stored (at h = 0.25 Å 36 % of the points are active).
struct BandBlock {
  Vec3i corner;       ///< lowest index
  Mask active, above; ///< above: the side of inactive points
  Mask stored;        ///< the active points, and some that seemed active before the neighbors were known
  const float* value; ///< G of the stored points, in order; belongs to the band
};

using BandBlocks = std::span<const BandBlock>;

/// Room for the values of a block, and for what vectors write behind them.
using BlockValues = std::array<float, 512 + 16>;
/// G of the active points of a block, in order: the block's own where it stores no other, else in `room`.
const float* active_values(const BandBlock& block, BlockValues& room);

/// The content of a BlockGrid in a third of its memory.
struct Band {
  GridFrame frame;
  FieldInfo info;
  LargeArray<BandBlock> block; ///< ascending; empty if a sink has received them
  std::vector<Vec3i> inside;   ///< ascending
  int64_t active_points = 0;
  std::vector<LargeArray<float>> storage;
};
BlockGrid to_block_grid(const Band& band, int threads);

/// True when a point on the grid's outermost layer has G > isovalue: the wall cuts the surface. Asked of active
/// blocks and of blocks that lie wholly inside.
bool wall_cuts_surface(const GridFrame& frame, const FieldInfo& info, BandBlocks blocks);
bool wall_cuts_surface(const GridFrame& frame, std::span<const Vec3i> inside);

} // namespace molmesh

template <>
inline constexpr bool molmesh::leave_untouched<molmesh::BandBlock> = true;
