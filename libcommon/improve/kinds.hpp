// kinds.hpp — what the vertices of a mesh may do.
#pragma once
#include "improve/dynamic_mesh.hpp"

namespace molmesh::improve {

/// Sets Label::axis, the walls and the vertices. label [tris]: indices into DynamicMesh::labels. Sliding needs
/// planes of distinct axes, surface one curved label that is a 2-manifold there without edges that bend by more
/// than `sharp` degrees.
void set_kinds(DynamicMesh& m, const TetMesh& mesh, const std::vector<uint8_t>& label, double sharp, int threads);

} // namespace molmesh::improve
