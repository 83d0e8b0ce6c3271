// pdb_text.cpp — the PDB format: our own strict look at each line, then gemmi's reader on the records that matter.
#include "base/error.hpp"
#include "formats/pdb/atom_line.hpp"
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/model_names.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/remark350.hpp"
#include "molecule/words.hpp"
#include <gemmi/pdb.hpp>

namespace molmesh::formats {
namespace {

/// Where columns 77-78 hold no element (then true): an ion's; in amino acids and nucleotides the first letter of
/// the atom's name ("CA  " is no calcium there), elsewhere gemmi decides, unless all that it finds is X.
bool set_element(std::string& line) {
  if (line.size() > 76 && (is_letter(line[76]) || (line.size() > 77 && is_letter(line[77]))))
    return false;
  const std::string name = line.substr(12, 4), residue(trimmed(std::string_view(line).substr(17, 3)));
  const auto set = [&line](std::string_view symbol) { // right-adjusted
    line.resize(76, ' ');
    line.append(2 - symbol.size(), ' ').append(symbol);
    return true;
  };
  if (const gemmi::Element ion = ion_element(trimmed(name), trimmed(std::string_view(line).substr(17, 4)));
      ion != gemmi::El::X)
    return set(ion.uname());
  const size_t first = name.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz");
  if (first == std::string::npos)
    return true;
  const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(residue);
  const bool polymer = (info.is_amino_acid() || info.is_nucleic_acid() || is_protonation_variant(residue)) &&
                       name.find("SE") == std::string::npos;
  if (!polymer && gemmi::Element(name.c_str()) != gemmi::El::X)
    return true;
  return set(std::string_view(name).substr(first, 1));
}

/// Residue numbers are integers, hybrid-36 in capitals, or missing. gemmi takes small letters for capitals, and
/// -999 for none.
bool is_residue_number(std::string_view field) {
  field = trimmed(field);
  const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
  if (field.size() == 4 && is_capital(field[0]))
    return std::all_of(field.begin(), field.end(), [&](char c) { return is_digit(c) || is_capital(c); });
  if (field == "-999")
    return false;
  if (!field.empty() && (field[0] == '-' || field[0] == '+'))
    field.remove_prefix(1);
  return std::all_of(field.begin(), field.end(), is_digit);
}

class PdbLines {
public:
  PdbLines(const std::string& file, bool assemblies_wanted) : file_(file), assemblies_wanted_(assemblies_wanted) {}

  void take(std::string_view line, int64_t number) {
    line_ = number;
    if (ended_)
      after_end_ += is_atom_record(line);
    else if (is_atom_record(line))
      atom(line);
    else if (is_record(line, "MODEL"))
      open_model(line);
    else if (is_record(line, "ENDMDL"))
      in_model_ = false;
    else if (is_record(line, "END") && (line.size() == 3 || line[3] == ' '))
      ended_ = true;
    else if (is_record(line, "TER") || is_record(line, "SEQRES"))
      text.append(line);
    else if (assemblies_wanted_ && is_record(line, "REMARK 350"))
      remark350_.take(line, file_ + ":" + std::to_string(number));
    text += '\n';
  }

  void finish(Parsed& parsed) const {
    if (atoms_ == 0)
      fail_input(file_ + ":" + std::to_string(std::max<int64_t>(line_, 1)) +
                 ": found the end without an ATOM or HETATM record, expected a structure");
    remark350_.finish();
    const auto note = [&](int64_t count, const std::string& what) {
      if (count > 0)
        parsed.notes.push_back(what + ": " + std::to_string(count));
    };
    note(shifted_, "atom lines whose coordinates stand one column to the right, read there");
    note(pushed_, "atom lines that a wide serial has moved to the right, read there");
    if (odd_numbers_ > 0)
      note(odd_numbers_, "residue numbers that are none, read as far as they go, the first in line " +
                             std::to_string(first_odd_number_));
    note(guessed_, "atoms without an element, taken from the name");
    note(after_end_, "atom lines after END, not read");
    note(names_.renumbered(), "models without a number of their own, numbered in order");
  }

  std::string text; ///< the records that matter, checked, for gemmi
  const std::vector<std::string>& models() const { return names_.all(); }
  const std::vector<gemmi::Assembly>& assemblies() const { return remark350_.assemblies; }

private:
  [[noreturn]] void refuse(const std::string& what) const {
    fail_input(file_ + ":" + std::to_string(line_) + ": " + what);
  }

  void atom(std::string_view line) {
    if (!in_model_)
      open_model("");
    ++atoms_;
    const AtomLine in_place = in_columns(line, room_);
    pushed_ += in_place.pushed;
    shifted_ += in_place.shifted;
    check_coordinates(in_place.text);
    record_ = in_place.text.substr(0, 78); // the formal charge behind is not used
    guessed_ += set_element(record_);
    if (!is_residue_number(std::string_view(record_).substr(22, 4)) && odd_numbers_++ == 0)
      first_odd_number_ = line_;
    text += record_;
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
    names_.next(record);
    const size_t models = names_.all().size();
    // gemmi reads four digits and wants ENDMDL and distinct numbers; the names come back afterwards.
    if (models > most_models)
      refuse("found more than " + std::to_string(most_models) + " models, expected fewer");
    if (models > 1)
      text += "ENDMDL\n";
    const std::string number = std::to_string(models);
    text += "MODEL     " + std::string(4 - number.size(), ' ') + number + "\n";
  }

  const std::string& file_;
  const bool assemblies_wanted_;
  Remark350 remark350_;
  ModelNames names_;
  std::string record_, room_;
  int64_t line_ = 0, atoms_ = 0, shifted_ = 0, after_end_ = 0, guessed_ = 0, pushed_ = 0, odd_numbers_ = 0,
          first_odd_number_ = 0;
  bool in_model_ = false, ended_ = false;
};

} // namespace

Parsed parse_pdb(std::string_view text, const std::string& file, const std::string& assembly) {
  PdbLines lines(file, assembly != "none");
  lines.text.reserve(text.size());
  for_each_line(text, [&](std::string_view line, int64_t number) { lines.take(line, number); });
  Parsed parsed;
  parsed.format = "PDB";
  lines.finish(parsed);
  gemmi::Structure& st = parsed.structure;
  try {
    st = gemmi::read_pdb_from_memory(lines.text.data(), lines.text.size(), "pdb");
  } catch (const std::runtime_error& e) {
    fail_input(file + ": " + std::string(e.what()).substr(0, std::string_view(e.what()).find('\n')));
  }
  for (size_t m = 0; m < st.models.size(); ++m)
    st.models[m].name = lines.models().at(m);
  st.assemblies = lines.assemblies(); // gemmi loses its columns from the 1000th operator on
  return parsed;
}

} // namespace molmesh::formats
