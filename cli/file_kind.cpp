// file_kind.cpp — signatures of the files that people give to the wrong program.
#include "cli/file_kind.hpp"
#include <algorithm>
#include <cctype>

namespace molmesh::cli {
namespace {

bool has(std::string_view head, std::string_view text) {
  return head.find(text) != std::string_view::npos;
}

/// Whether a line begins with one of the records of a PDB or PQR file.
bool is_pdb(std::string_view head) {
  for (size_t at = 0; at < head.size(); at = std::min(head.find('\n', at), head.size() - 1) + 1)
    for (const char* record : {"ATOM  ", "HETATM", "HEADER", "CRYST1", "REMARK ", "MODEL  "})
      if (head.substr(at).rfind(record, 0) == 0)
        return true;
  return false;
}

} // namespace

FileKind file_kind(std::string_view head) {
  const std::string structure = "run pdb2hier first", mesh = "tetsmooth, tetstat, tetlabel and tetconvert read it";
  const size_t first = head.find_first_not_of(" \t\r\n");
  const std::string_view text = first == std::string_view::npos ? std::string_view{} : head.substr(first);
  if (text.rfind("hier ", 0) == 0)
    return {".hier", "a hierarchy of atoms (.hier)", "run hier2density first"};
  if (head.rfind(" BDV", 0) == 0)
    return {".vdb", "a density grid (.vdb)", "run density2tet first"};
  if (has(head, "<VTKFile"))
    return {".vtu", "a mesh of VTK", mesh};
  if (text.rfind("$MeshFormat", 0) == 0)
    return {".vtu", "a mesh of Gmsh", mesh};
  if (text.rfind("MeshVersionFormatted", 0) == 0)
    return {".vtu", "a mesh of MEDIT", mesh};
  if (text.rfind("# vtk DataFile", 0) == 0)
    return {".vtu", "a mesh of VTK's older format", mesh};
  if (head.size() > 212 && head.substr(208, 4) == "MAP ")
    return {".map", "a map (CCP4/MRC)", "a structure or a .vdb is expected"};
  if (text.rfind("data_", 0) == 0 || has(head, "_atom_site."))
    return {"structure", "an mmCIF file", structure};
  if (has(head, "dataBlocks") || has(head, "mmtfVersion"))
    return {"structure", "a binary structure file", structure};
  if (is_pdb(text))
    return {"structure", "a structure (PDB or PQR)", structure};
  return {};
}

} // namespace molmesh::cli
