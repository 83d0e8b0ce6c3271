// region_summary.hpp — summarizes the regions of a mesh: number of tetrahedra, volume, boundary.
#pragma once
#include "mesh/surface.hpp"

namespace molmesh {

struct RegionSummary {
  int32_t region = 0;
  int64_t tets = 0;
  double volume = 0;       ///< Å³, sum over the tetrahedra
  SurfaceSummary boundary; ///< all its faces towards other regions or nothing, pointing out
};

/// Ascending. side: boundary_faces() of the mesh. Same result at any number of threads.
std::vector<RegionSummary> summarize_regions(const TetMesh& m, const std::vector<int64_t>& side, int threads);

} // namespace molmesh
