// parse.cpp — which format it is, and what no format may hold.
#include "formats/pdb/parse.hpp"
#include "base/error.hpp"
#include "formats/pdb/atom_line.hpp"
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/foreign.hpp"
#include "molecule/words.hpp"
#include <algorithm>

namespace molmesh::formats {
namespace {

bool ends_with(std::string_view name, std::string_view ending) {
  if (name.size() < ending.size())
    return false;
  return std::equal(ending.begin(), ending.end(), name.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

/// Byte order mark away, line ends to line feeds; refuses binary data.
void normalize(std::string& text, const std::string& file) {
  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0)
    text.erase(0, 3);
  if (const size_t nul = text.find('\0'); nul != std::string::npos) {
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n') + 1;
    fail_input(file + ":" + std::to_string(line) + ": found a NUL byte, expected text");
  }
  if (text.find('\r') != std::string::npos) {
    if (text.find('\n') == std::string::npos)
      std::replace(text.begin(), text.end(), '\r', '\n');
    else
      text.erase(std::remove(text.begin(), text.end(), '\r'), text.end());
  }
  if (!text.empty() && text.back() != '\n')
    text += '\n';
}

bool are_numbers(const std::vector<std::string_view>& word, size_t last) {
  return word.size() >= last && std::all_of(word.end() - static_cast<std::ptrdiff_t>(last), word.end(),
                                            [](std::string_view w) { return signed_decimal(w).has_value(); });
}

/// Occupancy and temperature factor, two %6.2f behind the coordinates; an occupancy is not negative.
bool has_occupancy(std::string_view line) {
  return line.size() >= 66 && line[57] == '.' && line[63] == '.' && line[54] != '-' && line[55] != '-' &&
         line[56] != '-' && (line.size() == 66 || line[66] == ' ');
}

/// "pdb" or "pqr"; empty for a line that could be either.
std::string format_of_atom(std::string_view as_it_is) {
  std::string room;
  const std::string_view line = in_columns(as_it_is, room).text;
  if (!has_pdb_columns(line))
    return words(as_it_is).size() >= 9 && are_numbers(words(as_it_is), 5) ? "pqr" : "pdb";
  const std::vector<std::string_view> behind = words(line.substr(54));
  if (behind.size() != 2 || !are_numbers(behind, 2))
    return "pdb";
  return has_occupancy(line) ? "" : "pqr";
}

/// A last line without its end, that has begun as an atom's and is shorter than the atom's before.
bool ends_within_atom_line(std::string_view text) {
  if (text.empty() || text.back() == '\n' || text.back() == '\r')
    return false;
  const size_t end = text.find_last_of("\r\n");
  if (end == std::string_view::npos)
    return false;
  const std::string_view last = text.substr(end + 1),
                         before = text.substr(0, text.find_last_not_of("\r\n", end) + 1),
                         atom = before.substr(before.find_last_of("\r\n") + 1);
  const bool has_begun =
      is_atom_record(last) || (last.size() < 6 && (std::string_view("ATOM  ").starts_with(last) ||
                                                   std::string_view("HETATM").starts_with(last)));
  return has_begun && is_atom_record(atom) && last.size() < atom.size();
}

std::string_view without_gz(std::string_view name) {
  if (ends_with(name, ".gz"))
    name.remove_suffix(3);
  return name;
}

/// Is what is called PQR the PDB format? Every line has an occupancy and a temperature factor in their columns, and
/// these are no radii, or most of the others are 1.00, which are no charges but of ions.
bool is_pdb_after_all(std::string_view text) {
  int64_t atoms = 0, in_place = 0, large = 0, ones = 0;
  std::string room;
  for_each_line(text, [&](std::string_view as_it_is, int64_t) {
    if (!is_atom_record(as_it_is))
      return;
    ++atoms;
    const std::string_view line = in_columns(as_it_is, room).text;
    if (!has_pdb_columns(line) || !has_occupancy(line))
      return;
    ++in_place;
    large += decimal(trimmed(line.substr(60, 6))).value_or(0) > believed_radius;
    ones += line.substr(54, 6) == "  1.00" &&
            ion_element(trimmed(line.substr(12, 4)), trimmed(line.substr(17, 4))) == gemmi::El::X;
  });
  return in_place == atoms && (large > 0 || (atoms >= 4 && 2 * ones > atoms));
}

std::string detect(std::string_view text, const std::string& file) {
  const std::string_view name = without_gz(file);
  const size_t first = text.find_first_not_of(" \t\n");
  if (first == std::string_view::npos)
    fail_input(file + ":1: found an empty file, expected a structure");
  if (text[first] == '{')
    return "mmjson";
  if (ends_with(name, ".pqr"))
    return is_pdb_after_all(text) ? "pdb" : "pqr";
  if (ends_with(name, ".gro"))
    return "gro";
  if (ends_with(name, ".xyzr") || ends_with(name, ".xyzrn"))
    return "xyzr";
  std::string format;
  for_each_line(text, [&](std::string_view line, int64_t) {
    if (!format.empty())
      return;
    const std::string_view start = trimmed(line);
    if (is_record(start, "DATA_") || start == "loop_")
      format = "mmcif";
    if (is_atom_record(line))
      format = format_of_atom(line);
  });
  if (format.empty() && (ends_with(name, ".cif") || ends_with(name, ".mmcif")))
    return "mmcif";
  if (format.empty() && looks_like_gro(text))
    return "gro";
  if (format.empty() && looks_like_xyzr(text))
    return "xyzr";
  return format.empty() ? "pdb" : format;
}

} // namespace

bool is_record(std::string_view line, std::string_view name) {
  return line.size() >= name.size() && std::equal(name.begin(), name.end(), line.begin(), [](char a, char b) {
           return a == (b >= 'a' && b <= 'z' ? b - 'a' + 'A' : b);
         });
}

bool is_atom_record(std::string_view line) {
  return is_record(line, "ATOM") || is_record(line, "HETATM");
}

bool has_pdb_columns(std::string_view line) {
  return line.size() >= 54 && line[34] == '.' && line[42] == '.' && line[50] == '.';
}

std::string in_quotes(std::string_view text) {
  size_t length = std::min<size_t>(text.size(), 40);
  while (length > 0 && length < text.size() && (text[length] & 0xC0) == 0x80) // whole characters of UTF-8
    --length;
  std::string s = "'";
  for (const char c : text.substr(0, length))
    s += static_cast<unsigned char>(c) >= 0x20 && c != 0x7F ? c : '?';
  return s + "'";
}

std::string note_of_large_radii(int64_t count) {
  return "radii of more than " + std::to_string(static_cast<int>(believed_radius)) + " Å: " + std::to_string(count);
}

Parsed parse_structure(std::string text, const std::string& file, const std::string& format,
                       const std::string& assembly) {
  if (format == "bcif" || (format == "auto" && looks_like_bcif(text)))
    return parse_bcif(text, file, assembly);
  if (format == "auto")
    refuse_foreign(text, file);
  const bool cut = ends_within_atom_line(text);
  normalize(text, file);
  const std::string kind = format == "auto" ? detect(text, file) : format;
  if (kind == "mmcif")
    return parse_mmcif(text, file, assembly);
  if (kind == "mmjson")
    return parse_mmjson(text, file, assembly);
  if (kind == "pqr")
    return parse_pqr(text, file, format == "pqr");
  if (kind == "gro")
    return parse_gro(text, file);
  if (kind == "xyzr")
    return parse_xyzr(text, file);
  Parsed parsed = parse_pdb(text, file, assembly);
  if (format == "auto" && ends_with(without_gz(file), ".pqr"))
    parsed.notes.emplace_back(
        "the file is called PQR and holds occupancies and temperature factors, no charges and "
        "radii: read as PDB (--format pqr takes them for charges and radii)");
  if (cut)
    parsed.notes.push_back("the file ends within an atom's line: is it cut off?");
  return parsed;
}

} // namespace molmesh::formats
