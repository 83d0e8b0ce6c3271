// surface.hpp — writers of the molecular surface as STL, PLY and OFF (SURFACE.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// Triangles of boundary label 1. Same mesh, same bytes; the stream's state tells whether all of it was written.
/// Throw Error(bad_input) "FILE: …" for a mesh without such triangles, write_stl for over 2^32 - 1.
void write_stl(std::ostream& out, const TetMesh& m, const std::string& file);
void write_ply(std::ostream& out, const TetMesh& m, const std::string& file);
void write_off(std::ostream& out, const TetMesh& m, const std::string& file);

} // namespace molmesh::formats
