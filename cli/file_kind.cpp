// file_kind.cpp — signatures of the files that people give to programs, and ways from one kind to another.
#include "cli/file_kind.hpp"
#include "base/small_letters.hpp"
#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <sstream>
#include <zlib.h>

namespace molmesh::cli {
namespace {

using std::string_view_literals::operator""sv;

bool has(std::string_view head, std::string_view text) {
  return head.find(text) != std::string_view::npos;
}

bool starts(std::string_view head, std::string_view text) {
  return head.substr(0, text.size()) == text;
}

/// The n-th line, from 0.
std::string_view line_of(std::string_view head, int n) {
  for (; n > 0 && !head.empty(); --n)
    head.remove_prefix(std::min(head.find('\n'), head.size() - 1) + 1);
  return head.substr(0, head.find_first_of("\r\n"));
}

/// Whether a line begins with one of the records of a PDB or PQR file.
bool is_pdb(std::string_view head) {
  for (size_t at = 0; at < head.size(); at = std::min(head.find('\n', at), head.size() - 1) + 1)
    for (const char* record : {"ATOM  ", "HETATM", "HEADER", "CRYST1", "REMARK ", "MODEL  "})
      if (starts(head.substr(at), record))
        return true;
  return false;
}

/// A number of atoms in the second line, and an atom of 44 columns in the third.
bool is_gro(std::string_view head) {
  const std::string_view count = line_of(head, 1), atom = line_of(head, 2);
  return count.find_first_of("0123456789") != std::string_view::npos &&
         count.find_first_not_of(" 0123456789") == std::string_view::npos && atom.size() >= 44 && atom[24] == '.' &&
         std::isdigit(static_cast<unsigned char>(atom[19])) != 0;
}

/// Four numbers in the first line, one at least with decimals (TetGen's .node has whole ones), and nothing but the
/// name of an atom behind them.
bool is_xyzr(std::string_view text) {
  std::istringstream line{std::string(line_of(text, 0))};
  std::string word, rest;
  bool decimals = false;
  for (int i = 0; i < 4; ++i) {
    if (!(line >> word) || word.find_first_not_of("+-.0123456789") != std::string::npos)
      return false;
    decimals |= word.find('.') != std::string::npos;
  }
  return decimals && (!(line >> rest) || rest == "1");
}

/// STL with 80 bytes of a title, the number of triangles, little-endian, and 50 bytes for each.
bool is_binary_stl(std::string_view head, uint64_t size) {
  if (head.size() < 84)
    return false;
  uint64_t n = 0;
  for (size_t i = 0; i < 4; ++i)
    n |= uint64_t{static_cast<unsigned char>(head[80 + i])} << 8 * i;
  return n > 0 && 84 + 50 * n == size;
}

constexpr const char* fill = "fill it with tetrahedra first, as tetgen -pqg does, whose .mesh is read";
constexpr const char* draw = "no program reads pictures; of a mesh, tetreport --png makes one";
constexpr const char* frame = "write one frame as PDB or .gro (gmx trjconv, VMD, MDAnalysis), then run pdb2hier";
constexpr const char* to_structure = "convert it with obabel -O x.pdb, then run pdb2hier";
constexpr const char* from_vtu = "it is made for another program; give the .vtu that it was made from";

struct Signature {
  size_t at;
  std::string_view bytes;
  const char *what, *way;
};
constexpr std::array<Signature, 25> signatures = {{
    {0, "\x89PNG"sv, "a picture (PNG)", draw},
    {0, "\xFF\xD8\xFF"sv, "a picture (JPEG)", draw},
    {0, "GIF8"sv, "a picture (GIF)", draw},
    {0, "II*\0"sv, "a picture (TIFF)", draw},
    {0, "MM\0*"sv, "a picture (TIFF)", draw},
    {0, "%PDF"sv, "a PDF document", "no program reads documents"},
    {0, "PK\x03\x04"sv, "a zip archive", "unpack it with unzip"},
    {0, "BZh"sv, "packed by bzip2", "unpack it with bunzip2"},
    {0,
     "\xFD"
     "7zXZ"sv,
     "packed by xz", "unpack it with xz -d"},
    {0, "\x28\xB5\x2F\xFD"sv, "packed by zstd", "unpack it with zstd -d"},
    {0, "7z\xBC\xAF"sv, "a 7z archive", "unpack it with 7z x"},
    {257, "ustar"sv, "a tar archive", "unpack it with tar -xf"},
    {0, "\x89HDF"sv, "an HDF5 file", "where it belongs to an .xdmf, give the .vtu that it was made from"},
    {4, "CORD"sv, "a trajectory (DCD)", frame},
    {0, "\x00\x00\x07\xC9"sv, "a trajectory (GROMACS TRR)", frame},
    {0, "\x00\x00\x07\xCB"sv, "a trajectory (GROMACS XTC)", frame},
    {0, "CDF"sv, "a trajectory (AMBER NetCDF)", frame},
    {0, "%VERSION"sv, "a topology (AMBER)", "convert it with ambpdb -p TOPOLOGY -c COORDINATES, then run pdb2hier"},
    {0, "PSF "sv, "a topology (PSF)", "write a PDB file with VMD or psfgen, then run pdb2hier"},
    {0, "@<TRIPOS>"sv, "a molecule (MOL2)", to_structure},
    {0, "mcsf_begin"sv, "a mesh of FEtk", from_vtu},
    {0, "*HEADING"sv, "a mesh of Abaqus", from_vtu},
    {0, "*NODE"sv, "a mesh of Abaqus", from_vtu},
    {0, "ply\n"sv, "a surface (PLY)", fill},
    {0, "ply\r"sv, "a surface (PLY)", fill},
}};

constexpr std::array<std::pair<Kind, std::string_view>, 8> endings = {{
    {Kind::structure, " .pdb .ent .cif .mmcif .bcif .mmtf .pqr .pdbqt .gro .xyzr .xyz .mol2 .sdf "},
    {Kind::hierarchy, " .hier "},
    {Kind::density, " .vdb "},
    {Kind::mesh,
     " .vtu .pvtu .vtp .vtk .msh .msh2 .mesh .meshb .node .ele .face .xdmf .h5 .m .stl .ply .off .obj .inp "
     ".bdf .nas "},
    {Kind::map, " .dx .map .ccp4 .mrc "},
    {Kind::plan, " .join "},
    {Kind::report, " .json "},
    {Kind::other, " .html .htm .png .jpg .jpeg .gif .svg .tif .tiff .bmp .webp .pdf .eps .ps "},
}};

FileKind surface(const std::string& format) {
  return {Kind::other, "a surface (" + format + ")", fill};
}

/// XML and HTML.
FileKind markup_kind(std::string_view head, std::string_view text) {
  const std::string lower = small_letters(std::string(text.substr(0, 1000)));
  if (has(head, "<VTKFile"))
    return has(head, "\"PolyData\"") ? surface("VTK PolyData") : FileKind{Kind::mesh, "a mesh of VTK", ""};
  if (has(lower, "<html") || starts(lower, "<!doctype html"))
    return {Kind::other, "a web page (HTML)",
            "a browser shows it; where it should be a structure, download the file itself and not its page"};
  if (has(lower, "<svg"))
    return {Kind::other, "a picture (SVG)", draw};
  if (has(lower, "<xdmf"))
    return {Kind::other, "a mesh in XDMF", from_vtu};
  if (has(lower, "<pdbx"))
    return {Kind::other, "a structure in XML (PDBML)", "take the entry as mmCIF, then run pdb2hier"};
  return {Kind::other, "XML", "of XML, only VTK's .vtu is read"};
}

std::string joined(const std::string& list, const std::string& more, const char* by) {
  return list.empty() ? more : list + by + more;
}

} // namespace

FileKind file_kind(std::string_view head, uint64_t size) {
  const size_t first = head.find_first_not_of(" \t\r\n");
  const std::string_view text = first == std::string_view::npos ? std::string_view{} : head.substr(first);
  for (const Signature& s : signatures)
    if (head.size() >= s.at && starts(head.substr(s.at), s.bytes))
      return {Kind::other, s.what, s.way};
  if (starts(text, "hier "))
    return {Kind::hierarchy, name_of(Kind::hierarchy), ""};
  if (starts(text, "join 1"))
    return {Kind::plan, name_of(Kind::plan), ""};
  if (starts(head, " BDV"))
    return {Kind::density, name_of(Kind::density), ""};
  if (starts(text, "<") || has(head, "<VTKFile"))
    return markup_kind(head, text);
  if (starts(text, "$MeshFormat"))
    return {Kind::mesh, "a mesh of Gmsh", ""};
  if (starts(text, "MeshVersionFormatted"))
    return {Kind::mesh, "a mesh of MEDIT", ""};
  if (starts(text, "# vtk DataFile"))
    return has(head, "DATASET POLYDATA") ? surface("VTK PolyData")
                                         : FileKind{Kind::mesh, "a mesh of VTK's older format", ""};
  if (head.size() > 212 && head.substr(208, 4) == "MAP ")
    return {Kind::map, "a map (CCP4/MRC)", ""};
  if (has(head, "class gridpositions"))
    return {Kind::map, "a map (OpenDX)", ""};
  if (starts(head, "OFF\n") || starts(head, "OFF\r") || starts(head, "OFF "))
    return surface("OFF");
  if ((starts(text, "solid") && has(head, "facet")) || is_binary_stl(head, size))
    return surface("STL");
  if ((starts(text, "v ") || has(head, "\nv ")) && (has(head, "\nf ") || has(head, "\nv ")))
    return surface("OBJ");
  if (starts(text, "data_") || has(head, "_atom_site."))
    return {Kind::structure, "a structure (mmCIF)", ""};
  if (has(head, "dataBlocks"))
    return {Kind::structure, "a structure (BinaryCIF)", ""};
  if (has(head, "mmtfVersion"))
    return {Kind::other, "a structure (MMTF)", "take the entry as mmCIF, then run pdb2hier"};
  if (starts(text, "{") || starts(text, "[")) {
    if (has(text.substr(0, 200), "\"data_"))
      return {Kind::structure, "a structure (mmJSON)", ""};
    if (has(head, "\"tool\"") && has(head, "\"phases\""))
      return {Kind::report, name_of(Kind::report), ""};
    return {Kind::other, "a JSON file",
            "of JSON, structures (mmJSON) and, by tetreport --runs, run reports are read"};
  }
  if (is_gro(head))
    return {Kind::structure, "a structure (.gro)", ""};
  if (is_pdb(text))
    return {Kind::structure, "a structure (PDB or PQR)", ""};
  if (is_xyzr(text))
    return {Kind::structure, "a structure (.xyzr)", ""};
  return {};
}

FileKind empty_file() {
  return {Kind::other, "an empty file", "has the program stopped that should have written it?"};
}

OpenedFile look_at_file(const std::string& path) {
  OpenedFile file;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    return file;
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error)
    return file;
  if (size == 0)
    return {empty_file(), false};
  std::string head(4096, '\0');
  if (const gzFile in = gzopen(path.c_str(), "rb")) { // reads other files as they are
    file.packed = gzdirect(in) == 0;
    head.resize(static_cast<size_t>(std::max(0, gzread(in, head.data(), static_cast<unsigned>(head.size())))));
    gzclose(in);
    file.kind = file_kind(head, file.packed ? 0 : size);
  }
  return file;
}

Kind kind_by_name(const std::string& path) {
  std::filesystem::path name(small_letters(path));
  if (name.extension() == ".gz")
    name = name.stem();
  if (name.extension().empty())
    return Kind::unknown;
  const std::string ending = ' ' + name.extension().string() + ' ';
  for (const auto& [kind, known] : endings)
    if (has(known, ending))
      return kind;
  return Kind::unknown;
}

std::string name_of(Kind kind) {
  switch (kind) {
  case Kind::structure:
    return "a structure (PDB, mmCIF, PQR and others)";
  case Kind::hierarchy:
    return "a hierarchy of atoms (.hier)";
  case Kind::density:
    return "a density grid (.vdb)";
  case Kind::mesh:
    return "a mesh of tetrahedra (.vtu, .vtk, .msh, .mesh)";
  case Kind::map:
    return "a map (CCP4/MRC, OpenDX, OpenVDB)";
  case Kind::plan:
    return "a plan (.join)";
  case Kind::report:
    return "a run report";
  case Kind::table:
    return "lines of text, as the program's page says";
  default:
    return "";
  }
}

std::string advice(const FileKind& found, Kind wanted, const std::string& program, bool main_input) {
  constexpr std::array<Kind, 4> chain = {Kind::structure, Kind::hierarchy, Kind::density, Kind::mesh};
  constexpr std::array<const char*, 3> step = {"pdb2hier", "hier2density", "density2tet"};
  constexpr std::array<const char*, 4> next = {"pdb2hier", "hier2density", "density2tet",
                                               "tetsmooth, tetstat, tetlabel, tetconvert or tetreport"};
  const auto place = [&](Kind kind) { return std::find(chain.begin(), chain.end(), kind) - chain.begin(); };
  const auto from = place(found.kind), to = place(wanted), end = static_cast<std::ptrdiff_t>(chain.size());
  if (found.kind == Kind::other)
    return found.way == fill && wanted != Kind::mesh
               ? "a surface has no atoms: start from a structure, with pdb2hier"
               : found.way;
  if (wanted == Kind::report)
    return "give the file that --report of a program wrote";
  if (found.kind == Kind::plan)
    return "hierjoin and densityjoin read it";
  if (found.kind == Kind::report)
    return "tetreport --runs reads it";
  if (wanted == Kind::plan && program == "densityjoin" && found.kind == Kind::density)
    return "name it with --piece";
  if (wanted == Kind::plan && program == "hierjoin" && found.kind == Kind::hierarchy)
    return "name it in the plan, in a line 'piece FILE'";
  if (found.kind == Kind::map) {
    const std::string way = to == end || to < place(Kind::density) ? "give it to map2density, which makes a .vdb"
                            : wanted == Kind::mesh                 ? "run map2density, then density2tet first"
                                                                   : "run map2density first";
    return way;
  }
  if (program == "tetlabel" && (wanted == Kind::mesh || wanted == Kind::hierarchy) &&
      (found.kind == Kind::mesh || found.kind == Kind::hierarchy))
    return "the mesh comes first, then the .hier";
  std::string steps;
  if (from < to && to < end) {
    for (auto i = from; i < to; ++i)
      steps = joined(steps, step[static_cast<size_t>(i)], ", then ");
    return "run " + steps + " first";
  }
  if (!main_input && to < from)
    return wanted == Kind::hierarchy ? "give the .hier that pdb2hier made" : "give the .vdb that hier2density made";
  constexpr std::array<const char*, 4> made = {"", "pdb2hier makes it from a structure; ",
                                               "hier2density makes it from a .hier; ",
                                               "density2tet makes it from a .vdb; "};
  const auto at = static_cast<size_t>(from);
  return std::string(to < from ? made[at] : "") + "give it to " + next[at];
}

} // namespace molmesh::cli
