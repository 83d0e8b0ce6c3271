// vtu.hpp — reader and writer of tetrahedral meshes as VTK unstructured grids (VTUv1.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// Any tetrahedral .vtu: ours, or a foreign one (ascii, inline base64 or appended; raw or zlib; Float32/64;
/// Int32/64; without our arrays: region 1 for all, triangles rebuilt). Throws Error(bad_input); hexahedra and other cells are refused.
TetMesh read_vtu(std::istream& in, const std::string& file);
/// Same mesh, same bytes.
void write_vtu(std::ostream& out, const TetMesh& mesh);

} // namespace molmesh::formats
