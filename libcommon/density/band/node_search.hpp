// node_search.hpp — the search within a node of 4³ blocks, in two rounds: alone, then among its neighbors.
#pragma once
#include "density/band/neighboring_search.hpp"
#include "density/band/node_state.hpp"
#include "density/band/workspace.hpp"
#include "density/culling/nodes.hpp"

namespace molmesh::density {

/// Keeps references to all that it is given. Calls for different nodes are independent.
class NodeSearch {
public:
  NodeSearch(const Field& f, const GridFrame& frame, const SearchOptions& o, const NodeList& nodes);
  /// Sides of the node's points, and values where they may be wanted.
  void work_through(const Node& node, NodeState& s, Workspace& w) const;
  /// The node's active points. below, above: of the 27 nodes around, as sides_around() gives them.
  void finish(NodeState& s, const FacedBits* const* below, const FacedBits* const* above, Workspace& w) const;

private:
  void work_through_block(int b, int octant, Vec3i corner, NodeState& s, Workspace& w) const;
  void settle(NodeState& s, Workspace& w) const;
  void store(NodeState& s, Workspace& w) const;
  /// The values of some points of block b of the node at work, put into the band's memory.
  const float* pack(int b, const uint64_t* points, Workspace& w) const;
  void evaluate_left_out(uint64_t blocks, uint64_t before, Vec3i node, Workspace& w) const;
  void need_neighbors(NodeState& s, RowHints& hint) const;
  void evaluate(Workspace& w, float* value) const;
  CellRange cells_of(Vec3i corner) const;
  /// Å, of the points of a cube of blocks.
  Vec3d middle_of(Vec3i corner, int32_t blocks) const {
    const Box box = points_box(frame_, corner, blocks);
    return 0.5 * (box.lo + box.hi);
  }

  const Field& f_;
  const GridFrame& frame_;
  const NodeList& nodes_;
  const bool full_; ///< compute every point
  const float lower_, upper_;
  const float far_below_,
      far_above_;        ///< a value that leaves a cell's other corners little chance to reach the band
  int dropped_bits_ = 0; ///< of a value's 23 after the leading one
};

} // namespace molmesh::density
