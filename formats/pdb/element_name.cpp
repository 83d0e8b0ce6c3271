// element_name.cpp — names of atoms and residues as the PDB and force fields write them.
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/parse.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <array>
#include <gemmi/resinfo.hpp>
#include <string>
#include <utility>

namespace molmesh::formats {
namespace {

/// The letters that the name begins with, digits and marks before them left out; in upper case.
std::string letters_of(std::string_view name) {
  const size_t first = std::min(name.find_first_not_of("0123456789'\"*+-"), name.size());
  std::string letters;
  for (const char c : name.substr(first)) {
    if (!is_letter(c))
      break;
    letters += c >= 'a' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return letters;
}

} // namespace

gemmi::Element ion_element(std::string_view atom, std::string_view residue) {
  static constexpr std::array<std::pair<std::string_view, gemmi::El>, 9> charmm = {{{"SOD", gemmi::El::Na},
                                                                                    {"CLA", gemmi::El::Cl},
                                                                                    {"POT", gemmi::El::K},
                                                                                    {"CAL", gemmi::El::Ca},
                                                                                    {"CES", gemmi::El::Cs},
                                                                                    {"LIT", gemmi::El::Li},
                                                                                    {"RUB", gemmi::El::Rb},
                                                                                    {"BAR", gemmi::El::Ba},
                                                                                    {"CAD", gemmi::El::Cd}}};
  const std::string name = letters_of(atom);
  if (residue == "ION" || residue == "IONS") // GROMACS and others: the residue says what its atom is
    residue = atom;
  for (const auto& [ion, element] : charmm) // NA of SOD, as programs write that know elements
    if (residue == ion && name.size() <= 2 && gemmi::Element(name) == element)
      return element;
  const size_t tail = residue.find_last_not_of("+-0123456789");
  if (name.empty() || tail == std::string_view::npos || letters_of(residue) != name || tail + 1 != name.size())
    return gemmi::El::X;
  for (const auto& [ion, element] : charmm)
    if (ion == name)
      return element;
  return name.size() <= 2 ? gemmi::Element(name) : gemmi::Element(gemmi::El::X);
}

namespace {

/// Cofactors whose metal is named like carbon or nitrogen with a letter behind.
bool holds_metal(std::string_view residue, std::string_view metal) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 10> known = {{{"CUA", "CU"},
                                                                                           {"CUB", "CU"},
                                                                                           {"CUZ", "CU"},
                                                                                           {"CUO", "CU"},
                                                                                           {"B12", "CO"},
                                                                                           {"CNC", "CO"},
                                                                                           {"COB", "CO"},
                                                                                           {"CBY", "CO"},
                                                                                           {"NCO", "CO"},
                                                                                           {"F43", "NI"}}};
  return std::find(known.begin(), known.end(), std::pair(residue, metal)) != known.end();
}

} // namespace

gemmi::Element named_element(std::string_view atom, std::string_view residue) {
  if (const gemmi::Element ion = ion_element(atom, residue); ion != gemmi::El::X)
    return ion;
  static constexpr std::array<std::string_view, 10> pairs = {"CL", "BR", "SI", "SE", "AS",
                                                             "FE", "ZN", "MG", "MN", "MO"};
  const std::string letters = letters_of(atom), pair = letters.substr(0, 2);
  if (letters.empty())
    return gemmi::El::X;
  if (std::find(pairs.begin(), pairs.end(), pair) != pairs.end() || (letters == pair && holds_metal(residue, pair)))
    return gemmi::Element(pair);
  return gemmi::impl::find_single_letter_element(letters[0]);
}

gemmi::Element element_in_columns(std::string_view field, std::string_view residue) {
  const std::string_view name = trimmed(field);
  if (const gemmi::Element ion = ion_element(name, residue); ion != gemmi::El::X)
    return ion;
  const std::string letters = letters_of(name);
  if (letters.empty())
    return gemmi::El::X;
  const gemmi::Element one = gemmi::impl::find_single_letter_element(letters[0]);
  const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(std::string(residue));
  if ((info.is_amino_acid() || info.is_nucleic_acid() || is_protonation_variant(residue)) &&
      field.find("SE") == std::string_view::npos)
    return one;
  if (is_letter(field[0]) || one == gemmi::El::X)
    return named_element(name, residue);
  return one;
}

gemmi::Element autodock_element(std::string_view type) {
  static constexpr std::array<std::pair<std::string_view, gemmi::El>, 17> types = {{{"A", gemmi::El::C},
                                                                                    {"HD", gemmi::El::H},
                                                                                    {"HS", gemmi::El::H},
                                                                                    {"NA", gemmi::El::N},
                                                                                    {"NS", gemmi::El::N},
                                                                                    {"OA", gemmi::El::O},
                                                                                    {"OS", gemmi::El::O},
                                                                                    {"SA", gemmi::El::S},
                                                                                    {"W", gemmi::El::O},
                                                                                    {"Z", gemmi::El::Zn},
                                                                                    {"GA", gemmi::El::C},
                                                                                    {"G", gemmi::El::C},
                                                                                    {"G0", gemmi::El::C},
                                                                                    {"G1", gemmi::El::C},
                                                                                    {"G2", gemmi::El::C},
                                                                                    {"G3", gemmi::El::C},
                                                                                    {"J", gemmi::El::C}}};
  std::string upper(type);
  for (char& c : upper)
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  for (const auto& [name, element] : types)
    if (name == upper)
      return element;
  if (upper.size() == 2 && upper[0] == 'C' && is_digit(upper[1])) // CG0: a carbon of a ring that is cut open
    return gemmi::El::C;
  if (upper.substr(0, 2) == "CG")
    return gemmi::El::C;
  return gemmi::Element(upper);
}

void ElementGuesses::add(std::string_view atom, std::string_view residue, gemmi::Element element,
                         bool of_one_letter) {
  ++all_;
  ++of_element_[element.name()];
  const std::string letters = letters_of(atom);
  if (letters.size() < 2 || letters[0] == 'H' || ion_element(atom, residue) != gemmi::El::X)
    return;
  const gemmi::Element pair(letters.substr(0, 2));
  static constexpr std::array<gemmi::El, 5> often = {gemmi::El::Cl, gemmi::El::Br, gemmi::El::Fe, gemmi::El::Se,
                                                     gemmi::El::Si}; // in any column
  const bool misplaced = of_one_letter && std::find(often.begin(), often.end(), pair.elem) != often.end();
  if ((of_one_letter || !pair.is_metal()) && !element.is_metal() && !misplaced)
    return;
  const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(std::string(residue));
  if (!info.is_amino_acid() && !info.is_nucleic_acid() && !is_protonation_variant(residue))
    ++doubtful_[std::string(atom) + " of " + std::string(residue) + " as " + element.name()];
}

void ElementGuesses::report(Parsed& parsed) const {
  for (const auto& [element, n] : of_element_)
    parsed.guessed[element] += n;
  if (doubtful_.empty())
    return;
  constexpr size_t most = 12;
  std::string list;
  int64_t atoms = 0;
  size_t named = 0;
  for (const auto& [guess, n] : doubtful_) {
    atoms += n;
    if (named++ < most)
      list += (list.empty() ? "" : ", ") + guess + (n > 1 ? " (" + std::to_string(n) + ")" : "");
  }
  parsed.notes.push_back("of these, names that could be a metal's or another element's: " + std::to_string(atoms) +
                         ", " + list + (named > most ? ", …" : ""));
}

bool is_protonation_variant(std::string_view residue) {
  static constexpr std::array<std::string_view, 16> names = {"HID", "HIE", "HIP", "HSD", "HSE", "HSP",
                                                             "ASH", "GLH", "LYN", "LYP", "ARN", "CYX",
                                                             "CYM", "CYN", "CYP", "TYM"};
  return std::find(names.begin(), names.end(), residue) != names.end();
}

gemmi::Element take_element(std::vector<std::string_view>& word) {
  if (word.empty() || word.back().size() > 2 || !std::all_of(word.back().begin(), word.back().end(), is_letter))
    return gemmi::El::X;
  const gemmi::Element element{std::string(word.back())};
  if (element != gemmi::El::X)
    word.pop_back();
  return element;
}

} // namespace molmesh::formats
