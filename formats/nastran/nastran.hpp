// nastran.hpp — writer of Nastran's bulk data, .bdf: GRID*, CTETRA, CTRIA3 (NASTRAN.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>
#include <string>

namespace molmesh::formats {

/// Throws Error(bad_input), which names `file`, where a number does not fit its field: over 99,999,999 points or
/// elements. Same mesh, same bytes. The stream's state tells whether all of it was written.
void write_nastran(std::ostream& out, const TetMesh& m, const std::string& file);

} // namespace molmesh::formats
