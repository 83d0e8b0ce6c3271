// xdmf.hpp — writer of XDMF with HDF5, as DOLFINx reads it (XDMF.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// h5_name: how the .xdmf names the .h5 file, which lies beside it. Same mesh, same bytes. The streams' states tell
/// whether all of it was written. Throws Error(failed) where the HDF5 library fails.
void write_xdmf(std::ostream& xdmf, std::ostream& h5, const std::string& h5_name, const TetMesh& m);

} // namespace molmesh::formats
