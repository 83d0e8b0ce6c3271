// brick_search.hpp — searches the band within a brick of 4³ blocks, in two rounds: alone, then among its neighbors.
#pragma once
#include "density/band/brick_state.hpp"
#include "density/band/neighboring_search.hpp"
#include "density/band/workspace.hpp"
#include "density/culling/bricks.hpp"

namespace molmesh::density {

/// Keeps references to all that it is given. Calls for different bricks are independent.
class BrickSearch {
public:
  BrickSearch(const Field& f, const GridFrame& frame, const SearchOptions& o, const BlockRange& own,
              const BrickList& bricks);
  /// Sides of the brick's points, and values where they may be wanted; of a brick beyond `own` blocks the sides
  /// alone, of the blocks next to them.
  void work_through(const Brick& brick, BrickState& s, Workspace& w) const;
  /// The brick's active points. below, above: of the 27 bricks around, as sides_around() gives them.
  void finish(BrickState& s, const FacedBits* const* below, const FacedBits* const* above, Workspace& w) const;

private:
  /// Blocks of a brick that are own, or next to own ones; by number.
  uint64_t wanted(Vec3i brick) const;
  void work_through_block(int b, int octant, Vec3i corner, BrickState& s, Workspace& w) const;
  void settle(BrickState& s, Workspace& w) const;
  void store(BrickState& s, Workspace& w) const;
  /// The values of some points of block b of the brick at work, put into the band's memory.
  const float* pack(int b, const uint64_t* points, Workspace& w) const;
  void evaluate_left_out(uint64_t blocks, uint64_t before, Vec3i brick, Workspace& w) const;
  void need_neighbors(BrickState& s, RowHints& hint) const;
  void evaluate(Workspace& w, float* value) const;
  CellRange cells_of(Vec3i corner) const;
  /// Å, of the points of a cube of blocks.
  Vec3d middle_of(Vec3i corner, int32_t blocks) const {
    const Box box = points_box(frame_, corner, blocks);
    return 0.5 * (box.lo + box.hi);
  }

  const Field& f_;
  const GridFrame& frame_;
  const BlockRange& own_;
  const BrickList& bricks_;
  const bool full_; ///< compute every point
  const float lower_, upper_;
  const float far_below_,
      far_above_;        ///< a value that leaves a cell's other corners little chance to reach the band
  int dropped_bits_ = 0; ///< of a value's 23 after the leading one
};

} // namespace molmesh::density
