// band_kernel.hpp — band cells by bit masks: from the values of blocks to the active points of a node of 4³ blocks,
// vectorized for the best instruction set of this machine.
#pragma once
#include <cstdint>

namespace molmesh::density {

/// A node is a cube of 4³ blocks; block 16·i + 4·j + k of it lies at (i, j, k).
constexpr int32_t node_blocks = 4, blocks_a_node = 64, node_edge = 32;

/// A set of the 32³ points of a node: bit z of row[x][y].
struct NodeBits {
  uint32_t row[node_edge][node_edge];
};

/// The same set, with what its neighbors need of it by itself: they would read a line of memory for every row.
struct FacedBits : NodeBits {
  uint32_t y_face[2][node_edge]; ///< rows at y = 0 and y = 31, by x
  uint32_t z_face[2][node_edge]; ///< points at z = 0 and z = 31, by x: bit y
};

/// The points of a node that are below the band and those that are above.
struct Sides {
  FacedBits below, above;
};

/// The same set by blocks: bit 8·j + k of word [block][i].
struct NodeWords {
  uint64_t word[blocks_a_node][8];
};

void rows_from_words(const NodeWords& words, NodeBits& rows);
/// With faces.
void faced_from_words(const NodeWords& words, FacedBits& to);
void words_from_rows(const NodeBits& rows, NodeWords& words);
int64_t count_points(const NodeWords& words);

/// Cells of a node and of the layer of cells before it: cell (i, j, k) lies between points i and i + 1, and so on;
/// those with first[axis] ≤ index < end[axis] lie in the grid, -1 is the lowest that touches the node.
struct CellRange {
  int32_t first[3], end[3];
};

/// Corners of band cells in a node: of cells whose corners are neither all below nor all above the band. below and
/// above: the sets of the 27 nodes around it, in order of (x, y, z), the node itself the 14th.
void band_points(const FacedBits* const* below, const FacedBits* const* above, const CellRange& cells,
                 NodeBits& active);

/// The same as far as the node knows it alone. What lies beyond its own points counts as `beyond` has it at the
/// nearest of them.
void likely_band_points(const Sides& sides, const Sides& beyond, const CellRange& cells, NodeBits& active);

} // namespace molmesh::density
