// kinds.hpp — what the vertices of a mesh may do.
#pragma once
#include "improve/dynamic_mesh.hpp"

namespace molmesh::improve {

/// Sets Label::axis and the vertices. Sliding needs planes of distinct axes, surface one curved label that is a
/// 2-manifold there without edges that bend by more than `sharp` degrees.
void set_kinds(DynamicMesh& m, const TetMesh& mesh, double sharp);

} // namespace molmesh::improve
