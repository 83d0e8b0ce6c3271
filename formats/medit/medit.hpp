// medit.hpp — reader and writer of MEDIT's .mesh, ASCII (MEDIT.md).
#pragma once
#include "formats/vtu/vtu.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// Of a whole file's bytes. Throws Error(bad_input).
TetMesh read_medit(const std::string& text, const std::string& file, const MeshReading& as, MeshNotes& notes);

/// Version 2. Same mesh, same bytes. The stream's state tells whether all of it was written.
void write_medit(std::ostream& out, const TetMesh& m);

} // namespace molmesh::formats
