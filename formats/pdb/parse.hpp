// parse.hpp — the text of a structure file into a structure.
#pragma once
#include "formats/pdb/structure.hpp"
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats {

/// Of a file: gemmi's numbers of PDB models have four digits, and it looks through mmCIF's for every atom of
/// another.
inline constexpr size_t most_models = 9999;

struct Parsed {
  pdb::Structure structure;
  std::string format; ///< "PDB", "mmCIF", "mmJSON", "PQR"
  /// Of formats that have charges or radii, by pdb::Atom::serial, which is then the index of the atom in the
  /// file.
  struct Values {
    double charge, radius; ///< e, Å; NaN: the file gives none
  };
  std::vector<Values> pqr;
  std::vector<std::string> notes;             ///< what the user should know about how the file was read
  std::map<std::string, int64_t> passed_over; ///< lines or categories that are no atoms, by record or name
  std::map<std::string, int64_t> guessed;     ///< elements that the file does not give, taken from the names
};

/// format: auto, pdb (PDBQT too), mmcif, bcif, mmjson, pqr, gro or xyzr; auto looks at the contents, and at the
/// name where PDB and PQR look alike. Throws Error(bad_input) "FILE:LINE: …" when there is no atom, or a coordinate
/// is not a finite number.
Parsed parse_structure(std::string text, const std::string& file, const std::string& format,
                       const std::string& assembly);

/// The single formats; `text` holds no NUL byte and ends its lines with a line feed.
Parsed parse_pdb(std::string_view text, const std::string& file, const std::string& assembly);
Parsed parse_mmcif(std::string_view text, const std::string& file, const std::string& assembly);
Parsed parse_mmjson(std::string_view text, const std::string& file, const std::string& assembly);
/// believed: radii of any size; otherwise those beyond believed_radius are refused.
Parsed parse_pqr(std::string_view text, const std::string& file, bool believed);
Parsed parse_gro(std::string_view text, const std::string& file);
Parsed parse_xyzr(std::string_view text, const std::string& file);
/// BinaryCIF: MessagePack.
Parsed parse_bcif(const std::string& bytes, const std::string& file, const std::string& assembly);

/// By contents.
bool looks_like_gro(std::string_view text);
bool looks_like_xyzr(std::string_view text);
bool looks_like_bcif(std::string_view bytes);

/// Å. No atom is larger, nor a bead that stands for a few.
inline constexpr double believed_radius = 10;
/// "radii of more than 10 Å: 3"
std::string note_of_large_radii(int64_t count);

/// Calls take(line, number) for each line, without its end.
template <class Take>
void for_each_line(std::string_view text, Take take) {
  int64_t number = 0;
  while (!text.empty()) {
    const size_t end = text.find('\n');
    take(text.substr(0, end), ++number);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}
/// Does the line begin with the record's name, in any case? name: upper case, at most six characters.
bool is_record(std::string_view line, std::string_view name);
/// Is it an ATOM or HETATM line?
bool is_atom_record(std::string_view line);
/// Does an atom line have the decimal points of three %8.3f in the PDB format's columns?
bool has_pdb_columns(std::string_view line);
/// The text without what does not print, quoted, for messages.
std::string in_quotes(std::string_view text);

} // namespace molmesh::formats
