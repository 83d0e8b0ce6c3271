// abaqus.hpp — writer of Abaqus' .inp: nodes, C3D4 elements, element sets, surfaces (ABAQUS.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// Same mesh, same bytes. The stream's state tells whether all of it was written.
void write_abaqus(std::ostream& out, const TetMesh& m);

} // namespace molmesh::formats
