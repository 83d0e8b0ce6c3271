// pdb_text.cpp — the PDB format (and PDBQT, which AutoDock writes in its columns), line by line.
#include "base/error.hpp"
#include "formats/pdb/atom_labels.hpp"
#include "formats/pdb/atom_line.hpp"
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/model_names.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/passed_over.hpp"
#include "formats/pdb/remark350.hpp"
#include "formats/pdb/structure_builder.hpp"
#include "molecule/words.hpp"
#include <limits>

namespace molmesh::formats {
namespace {

/// Of columns 77-78; X where they hold none.
gemmi::Element written_element(std::string_view line) {
  if (line.size() > 76 && (is_letter(line[76]) || (line.size() > 77 && is_letter(line[77])))) {
    const char symbol[3] = {line[76], line.size() > 77 ? line[77] : '\0', '\0'};
    return gemmi::Element(symbol);
  }
  return gemmi::El::X;
}

bool has_element(std::string_view line) {
  return line.size() > 76 && (is_letter(line[76]) || (line.size() > 77 && is_letter(line[77])));
}

double number_in(std::string_view line, size_t at, size_t width) {
  return at < line.size() ? signed_decimal(trimmed(line.substr(at, width))).value_or(0) : 0;
}

/// "  0.123 OA": the charge and type of AutoDock's atoms in columns 71-76 and 78-79.
bool has_autodock_type(std::string_view line) {
  return line.size() > 77 && line[72] == '.' && line[76] == ' ' && (is_letter(line[77]) || line[77] == '*') &&
         signed_decimal(trimmed(line.substr(70, 6))).has_value() && trimmed(line.substr(66, 4)).empty();
}

class PdbLines {
public:
  PdbLines(const std::string& file, bool assemblies_wanted, Parsed& parsed)
      : file_(file), assemblies_wanted_(assemblies_wanted), parsed_(parsed), passed_over_(file),
        builder_(parsed.structure) {}

  /// First of every line: what the columns of this file are.
  void look(std::string_view line) {
    if (is_atom_record(line))
      columns_.look(in_columns(line, room_, false).text);
  }

  void take(std::string_view line, int64_t number) {
    line_ = number;
    if (line_ == 1)
      columns_.finish();
    if (ended_)
      after_end_ += is_atom_record(line);
    else if (is_atom_record(line))
      atom(line);
    else if (is_record(line, "MODEL"))
      open_model(line);
    else if (is_record(line, "ENDMDL"))
      in_model_ = false;
    else if (is_end(line, "END"))
      ended_ = true;
    else if (is_end(line, "TER"))
      builder_.end_polymer();
    else if (is_record(line, "SEQRES"))
      builder_.add_sequence(line);
    else if (assemblies_wanted_ && is_record(line, "REMARK 350"))
      remark350_.take(line, file_ + ":" + std::to_string(number));
    else
      passed_over_.take(line, number);
  }

  void finish() {
    if (atoms_ == 0)
      fail_input(file_ + ":" + std::to_string(std::max<int64_t>(line_, 1)) +
                 ": found the end without an ATOM or HETATM record, expected a structure");
    remark350_.finish();
    builder_.finish();
    parsed_.structure.assemblies = remark350_.assemblies;
    if (types_ > 0)
      parsed_.format = "PDBQT";
    const auto note = [&](int64_t count, const std::string& what) {
      if (count > 0)
        parsed_.notes.push_back(what + ": " + std::to_string(count));
    };
    note(shifted_, "atom lines whose coordinates stand one column to the right, read there");
    note(pushed_, "atom lines that a wide serial has moved to the right, read there");
    note(segments_, "atoms without a chain, which has the name of their segment (columns 73-76)");
    if (odd_numbers_ > 0)
      note(odd_numbers_, "residue numbers that are none, read as far as they go, the first in line " +
                             std::to_string(first_odd_number_));
    note(numbers_.hexadecimal(), "atoms with a residue number that counts on in hexadecimal");
    note(builder_.restarted(), "residues whose number has started again, kept apart");
    note(guesses_.all(), "atoms without an element, taken from the name");
    guesses_.report(parsed_);
    note(after_end_, "atom lines after END, not read");
    note(names_.renumbered(), "models without a number of their own, numbered in order");
    passed_over_.report(parsed_);
  }

private:
  [[noreturn]] void refuse(const std::string& what) const {
    fail_input(file_ + ":" + std::to_string(line_) + ": " + what);
  }

  static bool is_end(std::string_view line, std::string_view name) {
    return is_record(line, name) && (line.size() == 3 || line[3] <= ' ');
  }

  void atom(std::string_view as_it_is) {
    if (!in_model_)
      open_model("");
    ++atoms_;
    const AtomLine in_place = in_columns(as_it_is, room_);
    pushed_ += in_place.pushed;
    shifted_ += in_place.shifted;
    const std::string_view line = in_place.text;
    check_coordinates(line);
    const AtomLabels labels = columns_.of(line);
    segments_ += labels.chain_of_segment;
    const ResidueNumbers::Number number = numbers_.read(labels.number);
    if (!number.is_number && odd_numbers_++ == 0)
      first_odd_number_ = line_;
    pdb::Atom atom;
    atom.name = builder_.label(trimmed(line.substr(12, 4)));
    atom.altloc = line[16] == ' ' ? '\0' : line[16];
    atom.pos = {number_in(line, first_x, coordinate_width),
                number_in(line, first_x + coordinate_width, coordinate_width),
                number_in(line, first_x + 2 * coordinate_width, coordinate_width)};
    atom.occ = line.size() > 57 ? static_cast<float>(number_in(line, 54, 6)) : 1.0F;
    atom.b_iso = line.size() > 63 ? static_cast<float>(number_in(line, 60, 6)) : 20.0F;
    if (has_autodock_type(line)) {
      ++types_;
      atom.element = autodock_element(trimmed(line.substr(77, 2)));
    } else if (has_element(line)) {
      atom.element = written_element(line);
    } else {
      atom.element = element_in_columns(line.substr(12, 4), labels.residue);
      guesses_.add(atom.name.str(), labels.residue, atom.element, !is_letter(line[12]));
    }
    atom.serial = static_cast<int32_t>(atoms_ - 1);
    if (types_ > 0) {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      parsed_.pqr.resize(static_cast<size_t>(atoms_), {none, none});
      if (has_autodock_type(line))
        parsed_.pqr.back().charge = number_in(line, 70, 6);
    }
    const pdb::ResidueId id{number.id, builder_.label(labels.segment), builder_.label(labels.residue)};
    builder_.add(labels.chain, id, is_record(line, "HETATM"), number.is_number, atom);
  }

  void check_coordinates(std::string_view line) const {
    constexpr size_t width = coordinate_width;
    if (line.size() < first_x + 3 * width)
      refuse("found an atom line of " + std::to_string(line.size()) +
             " columns, expected coordinates in columns 31-54");
    for (size_t at = first_x; at < first_x + 3 * width; at += width)
      if (!is_coordinate(line.substr(at, width)))
        refuse("found " + in_quotes(line.substr(at, width)) + " in columns " + std::to_string(at + 1) + "-" +
               std::to_string(at + width) + ", expected a coordinate (Å)");
  }

  /// record: its MODEL line, empty without one.
  void open_model(std::string_view record) {
    in_model_ = true;
    builder_.open_model(names_.next(record));
    if (names_.all().size() > most_models)
      refuse("found more than " + std::to_string(most_models) + " models, expected fewer");
  }

  const std::string& file_;
  const bool assemblies_wanted_;
  Parsed& parsed_;
  PassedOver passed_over_;
  StructureBuilder builder_;
  LabelColumns columns_;
  ResidueNumbers numbers_;
  ElementGuesses guesses_;
  Remark350 remark350_;
  ModelNames names_;
  std::string room_;
  int64_t line_ = 0, atoms_ = 0, shifted_ = 0, after_end_ = 0, pushed_ = 0, odd_numbers_ = 0, first_odd_number_ = 0,
          segments_ = 0, types_ = 0;
  bool in_model_ = false, ended_ = false;
};

} // namespace

Parsed parse_pdb(std::string_view text, const std::string& file, const std::string& assembly) {
  Parsed parsed;
  parsed.format = "PDB";
  PdbLines lines(file, assembly != "none", parsed);
  for_each_line(text, [&](std::string_view line, int64_t) { lines.look(line); });
  for_each_line(text, [&](std::string_view line, int64_t number) { lines.take(line, number); });
  lines.finish();
  return parsed;
}

} // namespace molmesh::formats
