// gmsh.hpp — reader and writer of Gmsh's .msh, formats 4.1 and 2.2 (GMSH.md).
#pragma once
#include "formats/vtu/vtu.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// ASCII or binary, of a whole file's bytes. Throws Error(bad_input).
TetMesh read_gmsh(const std::string& text, const std::string& file, const MeshReading& as, MeshNotes& notes);

enum class GmshVersion { v2_2, v4_1, v4_1_binary };

/// Same mesh, same bytes. The stream's state tells whether all of it was written.
void write_gmsh(std::ostream& out, const TetMesh& m, GmshVersion version);

} // namespace molmesh::formats
