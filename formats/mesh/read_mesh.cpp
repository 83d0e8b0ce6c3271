// read_mesh.cpp — the first bytes choose the reader.
#include "formats/mesh/read_mesh.hpp"
#include "formats/gmsh/gmsh.hpp"
#include "formats/medit/medit.hpp"
#include "formats/read_all.hpp"
#include "formats/text_in.hpp"
#include "formats/vtk/vtk.hpp"

namespace molmesh::formats {

TetMesh read_mesh(std::istream& in, const std::string& file, const MeshReading& as, MeshNotes& notes) {
  const std::string text = read_all(in, file);
  const std::string_view start = std::string_view(text).substr(0, 4096);
  if (start.substr(0, 5) == "# vtk")
    return read_vtk(text, file, as, notes);
  if (TextIn(file, start).word().substr(0, 1) == "$")
    return read_gmsh(text, file, as, notes);
  const std::string_view head = start.substr(0, 4);
  if (TextIn(file, start, '#').word().substr(0, 11) == "MeshVersion" || head == std::string_view("\1\0\0\0", 4) ||
      head == std::string_view("\0\0\0\1", 4))
    return read_medit(text, file, as, notes);
  return read_vtu(text, file, as, notes);
}

} // namespace molmesh::formats
