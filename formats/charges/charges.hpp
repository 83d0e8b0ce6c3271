// charges.hpp — the charges of a structure beside its mesh, for solvers (CHARGES.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include "molecule/hierarchy.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// Of the atoms whose charge is given and not 0, in the structure's order. Returns their number.
int64_t write_charges(std::ostream& out, const Hierarchy& h, const TetMesh& m);

} // namespace molmesh::formats
