// nodes.hpp — the grid in cubes of 4³ blocks, with the clusters that can matter in each. Only those that have any.
#pragma once
#include "density/band/band_simd.hpp"
#include "density/field/field.hpp"
#include "grid/block_grid.hpp"
#include <span>
#include <vector>

namespace molmesh::density {

/// A cube of blocks, and its clusters as a range of NodeList::cluster.
struct Node {
  Vec3i corner; ///< in blocks
  int64_t begin, end;
};

struct NodeList {
  std::vector<Node> node;      ///< ascending, corners at multiples of node_blocks from the grid's first block
  LargeArray<int32_t> cluster; ///< of a node: ascending
  std::span<const int32_t> clusters(const Node& n) const {
    return std::span(cluster).subspan(static_cast<size_t>(n.begin), static_cast<size_t>(n.end - n.begin));
  }
  /// Those of the node at `corner`; none when it has none.
  std::span<const int32_t> clusters_at(Vec3i corner) const;
};

/// Box of the points of a cube of blocks, Å, from block `corner` (in blocks).
Box points_box(const GridFrame& frame, Vec3i corner, int32_t blocks);
/// The first block (in blocks) of the grid, and whether a block has a point of it.
Vec3i first_block(const GridFrame& frame);
bool in_grid(const GridFrame& frame, Vec3i block);

/// Halves cubes of blocks, from one that holds the grid, and keeps for each the clusters nearer than their cutoff.
/// every: also the nodes of the grid without clusters.
NodeList nodes_by_halving(const Field& f, const GridFrame& frame, bool every, int threads);
/// The same list by a kd-tree, which every node near a cluster asks.
NodeList nodes_by_tree(const Field& f, const GridFrame& frame, bool every, int threads);

} // namespace molmesh::density
