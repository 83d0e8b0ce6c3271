// point_sets_simd.hpp — sets of the points of a brick of 4³ blocks, as rows along z or as words of blocks, and the
// blocks that they touch; vectorized for the best instruction set of this machine.
#pragma once
#include <cstdint>

namespace molmesh::density {

/// A brick is a cube of 4³ blocks; block 16·i + 4·j + k of it lies at (i, j, k).
constexpr int32_t brick_blocks = 4, blocks_a_brick = 64, brick_edge = 32;

/// A set of the 32³ points of a brick: bit z of row[x][y].
struct BrickBits {
  uint32_t row[brick_edge][brick_edge];
};

/// The same set, with what its neighbors need of it by itself: they would read a line of memory for every row.
struct FacedBits : BrickBits {
  uint32_t y_face[2][brick_edge]; ///< rows at y = 0 and y = 31, by x
  uint32_t z_face[2][brick_edge]; ///< points at z = 0 and z = 31, by x: bit y
};

/// The same set by blocks: bit 8·j + k of word [block][i].
struct BrickWords {
  uint64_t word[blocks_a_brick][8];
};

void rows_from_words(const BrickWords& words, BrickBits& rows);
/// With faces.
void faced_from_words(const BrickWords& words, FacedBits& to);
void words_from_rows(const BrickBits& rows, BrickWords& words);
int64_t count_points(const BrickWords& words);

/// Bit b: block b has a point of the set.
uint64_t blocks_of(const BrickWords& set);
/// Bit b: block b has a point of the set that is not in `other`.
uint64_t blocks_of_rest(const BrickWords& set, const BrickWords& other);
/// Bit b: block b has a point of the set that is not on a face of the brick.
uint64_t blocks_of_inner(const BrickWords& set);

} // namespace molmesh::density
