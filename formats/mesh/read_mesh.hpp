// read_mesh.hpp — a mesh in any of the formats that are read: .vtu, .msh, .mesh, .vtk (MESH.md).
#pragma once
#include "formats/vtu/vtu.hpp"

namespace molmesh::formats {

/// The format is known by the first bytes, whatever the file is called. Throws Error(bad_input), "FILE:LINE: Rn:
/// …". Memory beyond 64 MB: at most 20 times the bytes of the file.
TetMesh read_mesh(std::istream& in, const std::string& file, const MeshReading& as, MeshNotes& notes);

} // namespace molmesh::formats
