// node_words_simd.hpp — sets of the points of a node of 4³ blocks: by rows along z, by words of blocks, and the
// blocks that they touch; vectorized for the best instruction set of this machine.
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

/// The same set by blocks: bit 8·j + k of word [block][i].
struct NodeWords {
  uint64_t word[blocks_a_node][8];
};

void rows_from_words(const NodeWords& words, NodeBits& rows);
/// With faces.
void faced_from_words(const NodeWords& words, FacedBits& to);
void words_from_rows(const NodeBits& rows, NodeWords& words);
int64_t count_points(const NodeWords& words);

/// Bit b: block b has a point of the set.
uint64_t blocks_of(const NodeWords& set);
/// Bit b: block b has a point of the set that is not in `other`.
uint64_t blocks_of_rest(const NodeWords& set, const NodeWords& other);
/// Bit b: block b has a point of the set that is not on a face of the node.
uint64_t blocks_of_inner(const NodeWords& set);

} // namespace molmesh::density
