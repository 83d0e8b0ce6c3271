// tetgen.hpp — writer of TetGen's .node, .ele and .face (TETGEN.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// Same mesh, same bytes. The streams' states tell whether all of it was written.
void write_tetgen(std::ostream& node, std::ostream& ele, std::ostream& face, const TetMesh& m);

} // namespace molmesh::formats
