// vtu.hpp — reader and writer of tetrahedral meshes as VTK unstructured grids (VTUv1.md).
#pragma once
#include "mesh/tet_mesh.hpp"
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace molmesh::formats {

/// What the reader had to decide by itself.
struct MeshNotes {
  int64_t dropped_cells = 0;             ///< vertices and lines
  int64_t triangles = 0;                 ///< of a file without `boundary`: those are rebuilt from the tetrahedra
  int64_t dropped_triangles = 0;         ///< of these, not among the rebuilt ones
  bool region_missing = false;           ///< region 1 for all, or the values of region_array
  bool isovalue_missing = false;         ///< 1
  bool boundary_missing = false;         ///< label 1, of several regions also walls of the box
  std::string region_array;              ///< where regions were found; empty: in `region`, or nowhere
  std::vector<std::string> several;      ///< no array was chosen, and these have several values
  std::map<int32_t, int32_t> renumbered; ///< values below 1 of region_array: the regions that they became
  int64_t duplicate_points = 0; ///< points with the coordinates of an earlier one, in the mesh as it was read
  bool merged = false;          ///< these were merged into the earlier ones
  bool turned = false;          ///< every tetrahedron had a negative volume, and two corners changed places
  std::vector<std::string> passed_over; ///< what the file holds besides
};

/// What of these a user should know, a line each.
std::vector<std::string> described(const MeshNotes& notes);

/// What becomes of cell arrays beyond region, boundary and part, and of texts beyond source and creator.
enum class CellArrays { drop, keep };

/// What a user says about a file.
struct MeshReading {
  CellArrays arrays = CellArrays::drop;
  std::string region_array;  ///< the cell array that holds the regions; empty: `region`, or a usual name
  bool merge_points = false; ///< points with the same coordinates become one
  double scale = 1;          ///< Å in a unit of the file's coordinates
};

/// Any tetrahedral .vtu: ours, or a foreign one (ascii, inline base64 or appended; raw or zlib; Float32/64;
/// Int32/64; without our arrays: region 1 for all, triangles rebuilt; those of the file that are among them lend
/// them their values). Throws Error(bad_input), its line names the broken rule of VTUv1.md; hexahedra and other
/// cells are refused. Kept are arrays of one component that every piece has, integers or reals, and UInt8 arrays of
/// the field data as texts.
TetMesh read_vtu(std::istream& in, const std::string& file, MeshNotes* notes = nullptr,
                 CellArrays arrays = CellArrays::drop);
/// The same of a whole file's bytes. Error(bad_input) with the quantity "region-array" where the array of that name
/// is not there or holds no integers.
TetMesh read_vtu(const std::string& text, const std::string& file, const MeshReading& as, MeshNotes& notes);
/// Same mesh, same bytes. The stream's state tells whether all of it was written.
void write_vtu(std::ostream& out, const TetMesh& mesh);

} // namespace molmesh::formats
