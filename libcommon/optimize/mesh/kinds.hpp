// kinds.hpp — what the vertices of a mesh may do.
#pragma once
#include "optimize/mesh/dynamic_mesh.hpp"

namespace molmesh::optimize {

/// Of a triangle, a bit of its way: it points into the lower of the two regions, or into the mesh.
inline constexpr uint8_t reversed = 1;

/// Sets Label::axis, the walls and the vertices. label [tris]: indices into DynamicMesh::labels; way [tris].
/// Sliding needs planes of distinct axes, surface one curved label that is a 2-manifold there without edges that
/// bend by more than `sharp` degrees.
void set_kinds(DynamicMesh& m, const TetMesh& mesh, const std::vector<uint8_t>& label,
               const std::vector<uint8_t>& way, double sharp, int threads);

} // namespace molmesh::optimize
