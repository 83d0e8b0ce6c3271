// draft.hpp — values on blocks that hold more than the band, which becomes a BlockGrid with exactly the band (I2,
// I3).
#pragma once
#include "grid/block_grid.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::compose {

/// Blocks as in BlockGrid, with values where they are known and a side everywhere.
struct Draft {
  GridFrame frame;
  FieldInfo info;
  /// corner [n]     blocks with known values, ascending
  /// value [512 n]  slot as in BlockGrid; where it is not known 0 outside, inside_value inside
  /// known [8 n]    bits as BlockGrid::active
  std::vector<Vec3i> corner;
  LargeArray<float> value;
  LargeArray<uint64_t> known;
  std::vector<Vec3i> inside; ///< the other blocks that lie wholly inside, ascending
};

/// Corners of band cells become the active points, other points keep their side; cells end at the frame's walls.
/// unknown: how many active points have no known value; the grid is complete if there are none.
BlockGrid finish(Draft draft, int threads, int64_t& unknown);

} // namespace molmesh::compose
