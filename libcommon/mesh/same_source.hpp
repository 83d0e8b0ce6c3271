// same_source.hpp — tells whether a mesh was made from this density or structure.
#pragma once
#include "grid/block_grid.hpp"
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Whether both texts name the sha256 of a structure's file, and not the same.
bool other_structure(const std::string& source, const std::string& of_mesh);

/// Throws Error(bad_input) where both name the sha256 of their structure, or a mesh with a source has its isovalue
/// (has_isovalue), decay rate or number of atoms, and the two differ. Meshes of other programs name none.
/// `density`: the grid's file.
void require_same_source(const TetMesh& m, bool has_isovalue, const FieldInfo& field, const std::string& density);

} // namespace molmesh
