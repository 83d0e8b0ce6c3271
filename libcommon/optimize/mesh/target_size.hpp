// target_size.hpp — how long edges may be at each vertex: by the surface's curvature, growing with the distance
// from it.
#pragma once
#include "isosurface/target.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include <vector>

namespace molmesh::optimize {

/// By how much sizes grow along an edge, in parts of its length: at the ends of an edge no longer than they are,
/// they are at most 1.5 apart.
inline constexpr float size_growth = 0.5F;

/// Whether triangles of a curved label may get larger: of an isosurface, not of a surface that came in with the
/// mesh. target: the mesh's.
bool may_coarsen(const DynamicMesh& m, const Target* target, uint8_t label);

/// [vertices] Å, of edges. On a curved label that may_coarsen(): the edge of a triangle whose centroid is
/// `tolerance` (Å) off the target, by the curvature along the surface's edges at the vertex; no less than these
/// edges are on average, and no more than four times that. On others the average. Elsewhere as it grows from there;
/// 1e30 where no curved label is. Same result for any number of threads.
std::vector<float> target_sizes(const DynamicMesh& m, const Target* target, double tolerance, int threads);

} // namespace molmesh::optimize
