// vtk.hpp — reader of legacy .vtk files, versions 1 to 5, ASCII and binary (VTK.md).
#pragma once
#include "formats/vtu/vtu.hpp"

namespace molmesh::formats {

/// Of a whole file's bytes. Throws Error(bad_input).
TetMesh read_vtk(const std::string& text, const std::string& file, const MeshReading& as, MeshNotes& notes);

} // namespace molmesh::formats
