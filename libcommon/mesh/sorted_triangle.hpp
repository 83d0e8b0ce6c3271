// sorted_triangle.hpp — a triangle's corners ascending: what faces on the same three points have in common.
#pragma once
#include "mesh/group.hpp"
#include "mesh/tet_mesh.hpp"
#include <algorithm>

namespace molmesh {

struct SortedTriangle {
  Tri v;
  bool odd; ///< sorting took an odd permutation
};

/// Without branches: corners come in any order, and a guess is wrong half of the time.
inline SortedTriangle sorted_triangle(const Tri& t) {
  const auto [a, b, c] = t;
  const int32_t low = std::min(std::min(a, b), c), high = std::max(std::max(a, b), c);
  return {{low, a ^ b ^ c ^ low ^ high, high}, ((a > b) ^ (b > c) ^ (a > c)) != 0};
}

/// Equal for triangles on the same three points.
inline GroupKey triangle_key(const Tri& t) {
  const Tri v = sorted_triangle(t).v;
  return {v[0], uint64_t(uint32_t(v[1])) << 32 | uint32_t(v[2])};
}

} // namespace molmesh
