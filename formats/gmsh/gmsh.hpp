// gmsh.hpp — writer of Gmsh's .msh, formats 4.1 and 2.2, ASCII (GMSH.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>

namespace molmesh::formats {

enum class GmshVersion { v2_2, v4_1 };

/// Same mesh, same bytes. The stream's state tells whether all of it was written.
void write_gmsh(std::ostream& out, const TetMesh& m, GmshVersion version);

} // namespace molmesh::formats
