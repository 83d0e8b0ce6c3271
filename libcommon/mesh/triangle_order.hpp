// triangle_order.hpp — orders triangles along a space-filling curve, so that neighbors in the list are near in
// space.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Their indices in that order. Same result at any number of threads.
std::vector<int32_t> order_along_curve(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads);

inline std::vector<Tri> in_order(const std::vector<Tri>& tri, const std::vector<int32_t>& index) {
  std::vector<Tri> sorted;
  sorted.reserve(index.size());
  for (const int32_t t : index)
    sorted.push_back(tri[t]);
  return sorted;
}

} // namespace molmesh
