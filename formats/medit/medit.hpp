// medit.hpp — writer of MEDIT's .mesh, ASCII, version 2 (MEDIT.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// Same mesh, same bytes. The stream's state tells whether all of it was written.
void write_medit(std::ostream& out, const TetMesh& m);

} // namespace molmesh::formats
