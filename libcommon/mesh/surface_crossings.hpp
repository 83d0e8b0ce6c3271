// surface_crossings.hpp — finds triangles of a surface that cross one another, which no local rule of I6 tells.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

struct Crossings {
  int64_t pairs = 0;
  std::array<int32_t, 2> first{-1, -1}; ///< the pair with the lowest indices
};

/// Pairs of triangles that meet elsewhere than in common corners and edges (geom/intersect.hpp, exact).
/// O(n log n) for surfaces; same result at any number of threads.
Crossings find_crossings(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads);

} // namespace molmesh
