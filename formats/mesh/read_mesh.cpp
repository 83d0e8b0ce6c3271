// read_mesh.cpp — the first bytes choose the reader.
#include "formats/mesh/read_mesh.hpp"
#include "base/error.hpp"
#include "formats/gmsh/gmsh.hpp"
#include "formats/medit/medit.hpp"
#include "formats/read_all.hpp"
#include "formats/text_in.hpp"
#include "formats/vtk/vtk.hpp"
#include <cstdint>

namespace molmesh::formats {
namespace {

/// The format of a file of triangles alone; empty: none that is known.
std::string surface_format(std::string_view text) {
  const auto starts = [&](std::string_view with) { return text.substr(0, with.size()) == with; };
  if (starts("ply\n") || starts("ply\r"))
    return "PLY";
  if (starts("OFF\n") || starts("OFF\r") || starts("OFF "))
    return "OFF";
  if (starts("solid") && text.substr(0, 4096).find("facet") != text.npos)
    return "STL";
  constexpr size_t head = 84, triangle = 50; // binary STL: 80 bytes, the number, little-endian, and the triangles
  if (text.size() <= head)
    return "";
  uint64_t n = 0;
  for (size_t i = 0; i < 4; ++i)
    n |= uint64_t{static_cast<unsigned char>(text[80 + i])} << 8 * i;
  return head + triangle * n == text.size() ? "STL" : "";
}

/// Its first character is <, behind blanks and the mark of UTF-8.
bool begins_as_xml(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  if (text.substr(0, mark.size()) == mark)
    text.remove_prefix(mark.size());
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text[first] == '<';
}

} // namespace

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
  if (const std::string surface = surface_format(text); !surface.empty())
    fail_input(
        file + ":1: found a surface (" + surface +
        "), expected a mesh of tetrahedra: fill the surface first, as tetgen -pqg does, whose .mesh is read");
  if (!text.empty() && !begins_as_xml(start))
    fail_input(file + ":1: found no mesh of a format that is known, expected .vtu, .vtk, .msh or .mesh");
  return read_vtu(text, file, as, notes);
}

} // namespace molmesh::formats
