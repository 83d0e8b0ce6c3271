// mcsf.hpp — writer of FEtk's MC simplex format, .m (MCSF.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <cstdint>
#include <iosfwd>
#include <string>

namespace molmesh::formats {

/// Same mesh, same bytes. The stream's state tells whether all of it was written. Throws Error(bad_input), which
/// names `file`, for a label that is too large. Returns how many triangles with a label of their own, beyond
/// `surface`, have no place in it: those between two regions.
int64_t write_mcsf(std::ostream& out, const TetMesh& m, const std::string& file);

} // namespace molmesh::formats
