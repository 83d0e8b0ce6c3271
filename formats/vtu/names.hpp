// names.hpp — texts of a mesh that name what its labels count, as VTUv1.md has them.
#pragma once
#include "mesh/tet_mesh.hpp"
#include "molecule/hierarchy.hpp"
#include <map>

namespace molmesh::formats {

/// Adds LEVEL_names for every level and for atoms: line i names group i, percent-encoded as in a .hier.
void add_level_names(TetMesh& m, const Hierarchy& h);
/// Adds patch_names: lines "ID NAME".
void add_patch_names(TetMesh& m, const std::map<int32_t, std::string>& name);

/// Is it a name that meshes have themselves: of a region, or surface, box_x0 … box_z1?
bool is_own_name(const std::string& name);
/// Names of regions: molecule, outside, cavity, else region_N.
std::string region_name(int32_t region);
/// Names of the boundary labels that occur in `label`: surface, box_x0 … box_z1, then what patch_names has, else
/// boundary_N. Lines that are not "ID NAME" name nothing.
std::map<int32_t, std::string> boundary_names(const TetMesh& m, const std::vector<int32_t>& label);
/// The label of each triangle for boundary conditions: `patch` where the mesh has a positive one, else `boundary`.
std::vector<int32_t> patches(const TetMesh& m);

} // namespace molmesh::formats
