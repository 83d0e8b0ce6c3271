// sorted_triangle.hpp — a triangle's corners in ascending order, the key of faces on the same three points.
#pragma once
#include "mesh/group_by_key.hpp"
#include "mesh/tet_mesh.hpp"
#include <algorithm>
#include <utility>
#include <vector>

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

/// Numbers of triangles by their three points; of several triangles on the same points the lowest.
class TriangleNumbers {
public:
  /// number(t): of tri[t].
  template <class Number>
  TriangleNumbers(const std::vector<Tri>& tri, Number&& number) {
    for (size_t t = 0; t < tri.size(); ++t)
      known_.emplace_back(sorted_triangle(tri[t]).v, number(t));
    std::sort(known_.begin(), known_.end());
  }
  /// Null where there is none.
  const int32_t* find(const Tri& t) const {
    const Tri v = sorted_triangle(t).v;
    const auto k =
        std::lower_bound(known_.begin(), known_.end(), v, [](const auto& a, const Tri& b) { return a.first < b; });
    return k != known_.end() && k->first == v ? &k->second : nullptr;
  }

private:
  std::vector<std::pair<Tri, int32_t>> known_; ///< ascending
};

} // namespace molmesh
