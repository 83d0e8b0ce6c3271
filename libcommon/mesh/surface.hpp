// surface.hpp — computes the topology of oriented triangles: closed 2-manifolds, components, Euler number.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Places where triangles of one label are no closed oriented 2-manifold.
struct SurfaceFaults {
  int64_t open_edges = 0;     ///< in one triangle
  int64_t crowded_edges = 0;  ///< in more than two, or in two that run along it the same way
  int64_t pinched_points = 0; ///< with more than one fan of triangles
  std::array<int32_t, 2> open_edge{-1, -1}, crowded_edge{-1, -1}; ///< the first of each
  int32_t pinched_point = -1;
};

struct SurfaceSummary {
  int64_t triangles = 0, edges = 0, points = 0;
  int64_t components = 0; ///< connected through edges with two triangles
  int64_t euler = 0;      ///< points - edges + triangles
  double area = 0;        ///< Å²
  double volume = 0; ///< Å³ inside, of triangles that point out; NaN where nothing is enclosed (open, torn edges)
  SurfaceFaults faults;
};

/// One summary for each label 0 … labels - 1. `label` [triangles]; triangles of different labels do not see each
/// other. Same result at any number of threads.
std::vector<SurfaceSummary> summarize_surfaces(const std::vector<Vec3d>& point, const std::vector<Tri>& tri,
                                               const std::vector<int32_t>& label, int32_t labels, int threads);
/// All triangles with one label.
SurfaceSummary summarize_surface(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads);

} // namespace molmesh
