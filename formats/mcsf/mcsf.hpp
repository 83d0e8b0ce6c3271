// mcsf.hpp — writer of FEtk's MC simplex format, .m (MCSF.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// Same mesh, same bytes. The stream's state tells whether all of it was written.
void write_mcsf(std::ostream& out, const TetMesh& m);

} // namespace molmesh::formats
