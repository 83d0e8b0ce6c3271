// brick_state.hpp — what the search knows of a brick of 4³ blocks, and of slabs of bricks along x.
#pragma once
#include "density/band/active_set_simd.hpp"
#include "grid/band.hpp"
#include <array>
#include <limits>
#include <memory>
#include <vector>

namespace molmesh::density {

constexpr uint64_t every_block = ~uint64_t{0};

constexpr Vec3i block_at(int b) { // in a brick, in blocks
  return {b >> 4, b >> 2 & 3, b & 3};
}
constexpr Vec3i direction(int n) { // of the 27 bricks around one
  return {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
}

/// What a brick knows before its neighbors do: the sides of its points, and the values of those that look like
/// corners of band cells, block by block.
struct BrickPoints : Sides {
  BrickWords stored;
  const float* value[blocks_a_brick]; ///< of the stored points, in order; of evaluated blocks
};

/// Sets of blocks are bits, by number of the block in the brick.
struct BrickState {
  Vec3i corner;                   ///< in blocks
  uint64_t known = 0, inside = 0; ///< evaluated; not evaluated and above the band
  BrickPoints* sides = nullptr;   ///< none: all below the band, or all above it when `inside` is full
  std::vector<Vec3i> needed;      ///< bricks without clusters that this one may give corners of band cells
  uint64_t kept = 0, closed = 0;  ///< blocks with active points; without and inside
  LargeArray<BandBlock> band;     ///< of kept, in order
};

/// The bricks that begin at block x.
struct SlabState {
  int32_t x = std::numeric_limits<int32_t>::min();
  int64_t first = 0;             ///< of them in the BrickList
  std::vector<BrickState> brick; ///< ascending
  int64_t bricks() const { return static_cast<int64_t>(brick.size()); }
};

/// Bit 2·axis + (upper side): not every point of that face is below the band.
unsigned open_faces(const BrickState& s);

/// Where the three bricks along z in each of the nine rows around a brick were found last: the next one's are near.
using RowHints = std::array<size_t, 9>;

/// A brick of a slab among its neighbors: below[27] and above[27] as band_points() wants them. False when all are
/// on one side. before, after: the next slabs.
bool sides_around(const SlabState& before, const SlabState& slab, const SlabState& after, const BrickState& s,
                  RowHints& hint, const FacedBits** below, const FacedBits** above);

/// Puts the bricks that any of the slabs needs into the one in the middle.
void add_needed(const SlabState& before, SlabState& slab, const SlabState& after);

/// Puts what a slab keeps and encloses at the end of the band, ascending.
class SlabAppend {
public:
  /// blocks: not only what is inside. Makes room. The slab stays where and as it is until all parts are copied.
  SlabAppend(const SlabState& slab, bool blocks, Band& band);
  int64_t parts() const { return parts_; }
  /// Calls for different parts are independent.
  void copy(int64_t part) const;

private:
  /// Bricks of one y, as positions in the slab.
  struct Row {
    size_t begin, end;
  };
  static constexpr size_t rows_at_once = 8;
  template <class Use>
  void for_runs(size_t layer_of_row, Use&& use) const;

  const SlabState& slab_;
  const bool blocks_;
  std::vector<Row> rows_;
  std::vector<BandBlock*> block_; ///< where each layer of each row begins, layer by layer; then the end
  std::vector<Vec3i*> inside_;
  int64_t parts_;
};

} // namespace molmesh::density
