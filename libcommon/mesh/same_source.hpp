// same_source.hpp — is this density the one that the mesh was made from?
#pragma once
#include "density/block_grid.hpp"
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Throws Error(bad_input) where both name the sha256 of their structure, or a mesh with a source has its isovalue
/// (has_isovalue) or decay rate, and the two differ. Meshes of other programs name none. `density`: the grid's
/// file.
void require_same_source(const TetMesh& m, bool has_isovalue, const FieldInfo& field, const std::string& density);

} // namespace molmesh
