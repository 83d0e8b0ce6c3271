// foreign.hpp — fills in what meshes of other programs leave out.
#pragma once
#include "formats/vtu/vtu.hpp"

namespace molmesh::formats {

/// VTK's name of a type of cells, "cell" of those it does not know.
const char* vtk_cell_name(int64_t type);

/// From what a file holds to a mesh: regions, scale, merged points, triangles; what was decided is noted.
/// m: where notes.region_missing or notes.boundary_missing, those are 1 for all, and cell arrays tell more.
void complete_mesh(TetMesh& m, const std::string& file, const MeshReading& as, MeshNotes& notes);

} // namespace molmesh::formats
