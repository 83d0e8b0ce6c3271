// vtu.hpp — reader and writer of tetrahedral meshes as VTK unstructured grids (VTUv1.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>
#include <string>
#include <vector>

namespace molmesh::formats {

/// What the reader had to decide by itself.
struct VtuNotes {
  int64_t dropped_cells = 0;     ///< vertices and lines
  int64_t triangles = 0;         ///< of a file without `boundary`: those are rebuilt from the tetrahedra
  int64_t dropped_triangles = 0; ///< of these, not among the rebuilt ones
  bool region_missing = false;   ///< region 1 for all
  bool isovalue_missing = false; ///< 1
  bool boundary_missing = false; ///< label 1, of several regions also walls of the box
};

/// What of these a user should know, a line each.
std::vector<std::string> described(const VtuNotes& notes);

/// What becomes of cell arrays beyond region, boundary and part, and of texts beyond source and creator.
enum class CellArrays { drop, keep };

/// Any tetrahedral .vtu: ours, or a foreign one (ascii, inline base64 or appended; raw or zlib; Float32/64;
/// Int32/64; without our arrays: region 1 for all, triangles rebuilt; those of the file that are among them lend
/// them their values). Throws Error(bad_input), its line names the broken rule of VTUv1.md; hexahedra and other
/// cells are refused. Kept are arrays of one component that every piece has, integers or reals, and UInt8 arrays of
/// the field data as texts.
TetMesh read_vtu(std::istream& in, const std::string& file, VtuNotes* notes = nullptr,
                 CellArrays arrays = CellArrays::drop);
/// Same mesh, same bytes. The stream's state tells whether all of it was written.
void write_vtu(std::ostream& out, const TetMesh& mesh);

} // namespace molmesh::formats
