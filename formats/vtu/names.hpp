// names.hpp — texts of a mesh that name what its labels count, as VTUv1.md has them.
#pragma once
#include "mesh/tet_mesh.hpp"
#include "molecule/hierarchy.hpp"
#include <map>
#include <string>
#include <vector>

namespace molmesh::formats {

/// Adds LEVEL_names for every level and for atoms: line i names group i, percent-encoded as in a .hier.
void add_level_names(TetMesh& m, const Hierarchy& h);
/// Adds patch_names: lines "ID NAME".
void add_patch_names(TetMesh& m, const std::map<int32_t, std::string>& name);

/// Adds region_names and boundary_names and region_level: what density2tet --regions divides by.
void add_region_names(TetMesh& m, const std::string& level, const std::map<int32_t, std::string>& region,
                      const std::map<int32_t, std::string>& boundary);
/// The level that regions are groups of; empty: of none.
std::string region_level(const TetMesh& m);

/// Adds lines "ID NAME" to a text, names percent-encoded, and replaces those of the same numbers.
void add_names(TetMesh& m, const std::string& text_name, const std::map<int32_t, std::string>& name);
/// The lines "ID NAME" of a text: patch_names, region_names. Others name nothing.
std::map<int32_t, std::string> names_of(const TetMesh& m, const std::string& text_name);

/// Is it a name that meshes have themselves: of a region, or surface, box_x0 … box_z1, sphere?
bool is_own_name(const std::string& name);
/// Names of regions: molecule, outside, cavity, else region_N.
std::string region_name(int32_t region);
/// Those of the regions that the mesh has: what region_names has, else region_name.
std::map<int32_t, std::string> region_names(const TetMesh& m);
/// surface, box_x0 … box_z1 of labels 1 to 7, sphere of the outer boundary if that is one, else empty; and back: 0
/// of other names.
std::string own_boundary_name(const TetMesh& m, int32_t label);
int32_t own_boundary_label(const std::string& name);
/// Names of the boundary labels that occur in `label`: surface, box_x0 … box_z1 or sphere, then what boundary_names
/// or patch_names has, else boundary_N. Lines that are not "ID NAME" name nothing.
std::map<int32_t, std::string> boundary_names(const TetMesh& m, const std::vector<int32_t>& label);
/// The label of each triangle for boundary conditions: `patch` where the mesh has a positive one, else `boundary`.
std::vector<int32_t> patches(const TetMesh& m);

/// Labels as files for other programs have them: there no boundary has the number of a region, since some readers
/// keep one table for both. Where a label is one of ours (1 to 7 with our names) or a region has the same number,
/// `step` is added to every boundary label: the lowest power of ten, at least 10, that is above every region.
/// Regions keep their numbers.
struct ExportLabels {
  int32_t step = 0;
  std::vector<int32_t> patch;                             ///< [tris] numbers in the file
  std::map<int32_t, std::string> patch_name, region_name; ///< by numbers in the file, those that occur
};
/// Throws Error(bad_input) where a sum is over 2^31 - 1.
ExportLabels export_labels(const TetMesh& m);

} // namespace molmesh::formats
