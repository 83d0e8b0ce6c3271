// foreign.cpp — signatures of compressed, binary and text formats, and what converts them.
#include "formats/pdb/foreign.hpp"
#include "base/error.hpp"
#include "formats/pdb/parse.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <array>

namespace molmesh::formats {
namespace {

struct Signature {
  size_t at;
  std::string_view bytes, what, way;
};

using std::string_view_literals::operator""sv;

constexpr std::array<Signature, 17> signatures = {{
    {0,
     "\xFD"
     "7zXZ"sv,
     "xz data", "decompress it with xz -d"},
    {0, "BZh"sv, "bzip2 data", "decompress it with bunzip2"},
    {0, "\x28\xB5\x2F\xFD"sv, "zstd data", "decompress it with zstd -d"},
    {0, "\x1F\x9D"sv, "compress (.Z) data", "decompress it with gzip -d"},
    {0, "PK\x03\x04"sv, "a zip archive", "unpack it with unzip"},
    {0, "\x1F\x8B"sv, "gzip data within gzip data", "decompress it with gunzip"},
    {257, "ustar"sv, "a tar archive", "unpack it with tar -x"},
    {0, "\x89HDF"sv, "HDF5", "convert it with mdconvert or MDAnalysis"},
    {4, "CORD"sv, "a DCD trajectory", "write a frame as PDB with VMD or MDAnalysis"},
    {0, "\x00\x00\x07\xC9"sv, "a GROMACS trajectory (TRR)", "write a frame with gmx trjconv -o x.gro"},
    {0, "\x00\x00\x07\xCB"sv, "a GROMACS trajectory (XTC)", "write a frame with gmx trjconv -o x.gro"},
    {0, "%VERSION"sv, "an AMBER topology", "convert it with ambpdb -p TOPOLOGY -c COORDINATES"},
    {0, "PSF"sv, "a PSF topology", "write a PDB file with VMD or psfgen"},
    {0, "<?xml"sv, "XML (PDBML?)", "take the entry as mmCIF"},
    {0, "<PDBx"sv, "PDBML", "take the entry as mmCIF"},
    {0, "@<TRIPOS>"sv, "MOL2", "convert it with obabel -imol2 FILE -O x.pdb"},
    {0, "s_m_m2io"sv, "a Maestro file", "write a PDB file with Maestro or structconvert"},
}};

[[noreturn]] void refuse(const std::string& file, std::string_view what, std::string_view way) {
  fail_input(file + ":1: found " + std::string(what) +
             ", expected PDB, PDBQT, mmCIF, BinaryCIF, mmJSON, PQR, .gro or .xyzr: " + std::string(way));
}

} // namespace

void refuse_foreign(std::string_view bytes, const std::string& file) {
  for (const Signature& s : signatures)
    if (bytes.size() >= s.at + s.bytes.size() && bytes.substr(s.at, s.bytes.size()) == s.bytes)
      refuse(file, s.what, s.way);
  const std::string_view head = bytes.substr(0, 4096);
  if (head.find("mmtfVersion") != std::string_view::npos)
    refuse(file, "MMTF", "take the entry as mmCIF");
  if (head.find("@<TRIPOS>") != std::string_view::npos)
    refuse(file, "MOL2", "convert it with obabel -imol2 FILE -O x.pdb");
  std::array<std::string_view, 4> line;
  for_each_line(head, [&](std::string_view l, int64_t number) {
    if (number <= 4)
      line[static_cast<size_t>(number - 1)] = trimmed(l.substr(0, l.find('\r')));
  });
  if (line[3].size() > 5 &&
      (line[3].substr(line[3].size() - 5) == "V2000" || line[3].substr(line[3].size() - 5) == "V3000"))
    refuse(file, "an MDL molfile (SDF)", "convert it with obabel -isdf FILE -O x.pdb");
  const std::vector<std::string_view> third = words(line[2]), count = words(line[0]);
  const auto is_number = [](std::string_view w) { return signed_decimal(w).has_value(); };
  if (count.size() == 1 && std::all_of(count[0].begin(), count[0].end(), is_digit) && third.size() >= 4 &&
      is_letter(third[0][0]) && third[0].size() <= 2 && is_number(third[1]) && is_number(third[2]) &&
      is_number(third[3]))
    refuse(file, "XYZ", "convert it with obabel -ixyz FILE -O x.pdb");
  if (line[0].substr(0, 1) == "*" && line[1].substr(0, 1) == "*")
    refuse(file, "CHARMM coordinates (CRD)", "write a PDB file with CHARMM, VMD or MDAnalysis");
}

} // namespace molmesh::formats
