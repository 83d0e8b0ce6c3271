// passed_over.cpp — the records of the PDB format by name, and what an atom's line looks like without its name.
#include "formats/pdb/passed_over.hpp"
#include "base/error.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <array>

namespace molmesh::formats {
namespace {

/// Of PDB 3.3 and before, PDBQT, and programs that are often met.
bool is_known(std::string_view name) {
  static constexpr std::array<std::string_view, 76> names = {
      "HEADER", "OBSLTE", "TITLE",  "SPLIT",  "CAVEAT", "COMPND", "SOURCE", "KEYWDS", "EXPDTA", "NUMMDL", "MDLTYP",
      "AUTHOR", "REVDAT", "SPRSDE", "JRNL",   "REMARK", "DBREF",  "DBREF1", "DBREF2", "SEQADV", "SEQRES", "MODRES",
      "HET",    "HETNAM", "HETSYN", "FORMUL", "HELIX",  "SHEET",  "TURN",   "SSBOND", "LINK",   "LINKR",  "CISPEP",
      "SITE",   "CRYST1", "ORIGX1", "ORIGX2", "ORIGX3", "SCALE1", "SCALE2", "SCALE3", "MTRIX1", "MTRIX2", "MTRIX3",
      "TVECT",  "MODEL",  "ANISOU", "TER",    "ENDMDL", "CONECT", "MASTER", "END",    "SIGATM", "SIGUIJ", "HYDBND",
      "SLTBRG", "FTNOTE", "USER",   "ATOM",   "HETATM", "ROOT",   "ENDROO", "BRANCH", "ENDBRA", "TORSDO", "BEGIN_",
      "END_RE", "PARENT", "TARGET", "METHOD", "MODRED", "TITEL",  "CRYST",  "SSBON",  "NUMMD",  "COMPN"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string record_of(std::string_view line) {
  std::string name(trimmed(line.substr(0, 6)));
  for (char& c : name)
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return name.substr(0, name.find_first_of(" \t"));
}

/// Letters that must change, come or go.
size_t distance(std::string_view a, std::string_view b) {
  std::array<size_t, 16> row{};
  for (size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

bool looks_like_atom(std::string_view line, std::string_view record) {
  const std::string_view text = trimmed(line);
  const auto three = [](std::string_view l) {
    return has_pdb_columns(l) && signed_decimal(trimmed(l.substr(30, 8))) &&
           signed_decimal(trimmed(l.substr(38, 8))) && signed_decimal(trimmed(l.substr(46, 8)));
  };
  if (three(line) || three(text))
    return true;
  size_t decimals = 0;
  for (const std::string_view word : words(text))
    decimals += word.find('.') != std::string_view::npos && signed_decimal(word).has_value();
  const bool almost =
      record.size() > 2 && record.size() < 8 &&
      (distance(record, "ATOM") <= 1 || distance(record, "HETATM") <= 2 || record == "ATOM" || record == "HETATM");
  return decimals >= 3 && (almost || words(text).size() >= 8);
}

} // namespace

void PassedOver::take(std::string_view line, int64_t number) {
  const std::string_view text = trimmed(line);
  if (text.empty())
    return;
  if (text[0] == '#') {
    ++count_["#"];
    return;
  }
  const bool begins = line[0] != ' ' && line[0] != '\t';
  const std::string record = record_of(text);
  if (begins && is_known(record)) {
    ++count_[record];
    return;
  }
  if (looks_like_atom(line, record))
    fail_input(
        file_ + ":" + std::to_string(number) + ": found an atom " +
        (is_atom_record(text)
             ? std::string("behind a blank")
             : "under the name " + in_quotes(line.substr(0, std::min(line.find_first_of(" \t", 1), size_t{6})))) +
        ", expected ATOM or HETATM in column 1");
  ++count_["(unknown)"];
  if (unknown_++ == 0) {
    first_line_ = number;
    first_ = in_quotes(text.substr(0, text.find_first_of(" \t")));
  }
}

void PassedOver::report(Parsed& parsed) const {
  for (const auto& [record, n] : count_)
    parsed.passed_over[record] += n;
  if (unknown_ > 0)
    parsed.notes.push_back("lines of no known record, not read: " + std::to_string(unknown_) +
                           ", the first is line " + std::to_string(first_line_) + " (" + first_ + ")");
}

} // namespace molmesh::formats
