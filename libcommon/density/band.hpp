// band.hpp — band cells: which grid points are active, and which blocks must be known for that; the band, packed.
// A cell is a band cell when its corners are neither all below band_lower nor all above band_upper.
#pragma once
#include "density/block_grid.hpp"
#include <array>

namespace molmesh::density {

/// 8³ points: bit 8·j + k of word i.
using Mask = std::array<uint64_t, 8>;

/// A block with active points. 36 % of its points are active when h is a quarter of an Å: the others are not
/// stored.
struct BandBlock {
  Vec3i corner;       ///< lowest index
  Mask active, above; ///< above: the side of inactive points
  const float* value; ///< G of the active points, in order; belongs to the band
};

/// What BlockGrid holds, in a third of its memory.
struct Band {
  GridFrame frame;
  FieldInfo info;
  std::vector<BandBlock> block; ///< ascending
  std::vector<Vec3i> inside;    ///< ascending
  int64_t active_points = 0;
  std::vector<LargeArray<float>> storage;
};
BlockGrid to_block_grid(const Band& band, int threads);

/// A block whose values are known.
struct KnownBlock {
  const float* value; ///< [512]
  Mask below, above;  ///< of the band
};

struct KnownCorner {
  Vec3i corner;
  const KnownBlock* block;
};

/// What is known of the grid: blocks with values; blocks above the band at every point; all others are below it.
struct KnownBlocks {
  std::vector<KnownCorner> known; ///< ascending
  std::vector<Vec3i> inside;      ///< ascending, none of them known
  void append(const KnownBlocks& more);
};

/// A range of x of the corners of blocks: [begin, end).
struct Slab {
  int32_t begin, end;
};

/// Ascending, the blocks of the slab that are not known and have a corner of a band cell. `blocks` must cover the
/// slab and the blocks next to it.
std::vector<Vec3i> blocks_missing_from_band(const KnownBlocks& blocks, Slab slab, const GridFrame& frame,
                                            int threads);

/// Appends the slab's blocks that have active points to the band, and those that are inside to band.inside. None of
/// the slab may be missing.
void append_slab(const KnownBlocks& blocks, Slab slab, Band& band, int threads);

} // namespace molmesh::density
