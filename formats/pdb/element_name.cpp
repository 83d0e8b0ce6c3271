// element_name.cpp — names of atoms and residues as the PDB and force fields write them.
#include "formats/pdb/element_name.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <array>
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
  const size_t tail = residue.find_last_not_of("+-0123456789");
  if (name.empty() || tail == std::string_view::npos || letters_of(residue) != name || tail + 1 != name.size())
    return gemmi::El::X;
  for (const auto& [ion, element] : charmm)
    if (ion == name)
      return element;
  return name.size() <= 2 ? gemmi::Element(name) : gemmi::Element(gemmi::El::X);
}

gemmi::Element named_element(std::string_view atom, std::string_view residue) {
  if (const gemmi::Element ion = ion_element(atom, residue); ion != gemmi::El::X)
    return ion;
  static constexpr std::array<std::string_view, 9> pairs = {"CL", "BR", "SI", "SE", "FE", "ZN", "MG", "MN", "CU"};
  const std::string letters = letters_of(atom), pair = letters.substr(0, 2);
  if (letters.empty())
    return gemmi::El::X;
  if (std::find(pairs.begin(), pairs.end(), pair) != pairs.end())
    return gemmi::Element(pair);
  return gemmi::impl::find_single_letter_element(letters[0]);
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
