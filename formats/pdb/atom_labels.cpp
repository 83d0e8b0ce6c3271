// atom_labels.cpp — names and numbers wider than the columns that the PDB format gives them.
#include "formats/pdb/atom_labels.hpp"
#include "formats/pdb/element_name.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <gemmi/resinfo.hpp>
#include <vector>

namespace molmesh::formats {
namespace {

constexpr size_t residue_at = 17, fourth_at = 20, chain_at = 21, number_at = 22, segment_at = 72, element_at = 76;

char column(std::string_view line, size_t at) {
  return at < line.size() && line[at] != '\t' ? line[at] : ' ';
}

std::string columns(std::string_view line, size_t at, size_t width) {
  std::string s;
  for (size_t i = at; i < at + width; ++i)
    s += column(line, i);
  return s;
}

/// Amino acids with the fourth letter that GROMACS and CHARMM give some of them.
bool is_named_with_four(std::string_view name) {
  static constexpr std::array<std::string_view, 17> names = {"LYSH", "ASPH", "GLUH", "CYSH", "HISH", "HISA",
                                                             "HISB", "HISD", "HISE", "HIS1", "HIS2", "CYS1",
                                                             "CYS2", "ARGN", "LYSN", "ALAD", "TYRU"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_amino_acid(std::string_view name) {
  const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(std::string(name));
  return (info.is_amino_acid() && info.is_standard()) || is_protonation_variant(name);
}

int decimal_or(std::string_view text, int otherwise) {
  text = trimmed(text);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : otherwise;
}

/// labels: columns 18-27. Is `other` the residue before or behind it in the same chain, without a letter in column
/// 21?
bool are_neighbours(std::string_view labels, std::string_view other) {
  if (other.size() < 9 || labels.size() < 9 || other[3] != ' ' || other[4] != labels[4])
    return false;
  constexpr int none = 1 << 29;
  const int a = decimal_or(labels.substr(5, 4), none), b = decimal_or(other.substr(5, 4), -none);
  return std::abs(a - b) <= 1;
}

/// A name of five letters and more, its number behind a blank: "CER160  1".
bool is_wider(std::string_view line) {
  if (column(line, chain_at) == ' ' || column(line, number_at) == ' ')
    return false;
  const std::string text = columns(line, residue_at, 10);
  const std::vector<std::string_view> word = words(text);
  return word.size() == 2 && text[0] != ' ' && word[0].size() > 5 && is_letter(word[0][0]) &&
         decimal_or(word[1], -1) >= 0;
}

bool are_all(std::string_view text, bool (*is)(char)) {
  return std::all_of(text.begin(), text.end(), is);
}
bool is_capital(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_hexadecimal(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

/// What columns 73-80 held before 1996: the entry and the number of the line.
bool is_line_number(std::string_view line) {
  const std::string text = columns(line, element_at, 4);
  const std::string_view number = trimmed(text);
  return !number.empty() && are_all(number, is_digit);
}

} // namespace

void LabelColumns::look(std::string_view line) {
  const char fourth = column(line, fourth_at);
  if (fourth == ' ' && run_.chain.empty()) {
    if (line.size() > 26)
      before_.assign(line.substr(residue_at, 10));
    return;
  }
  const std::string labels = columns(line, residue_at, 10);
  if (fourth == ' ' || labels.compare(3, 2, run_.chain) != 0)
    end_run(labels);
  if (fourth != ' ' && !is_wider(line)) {
    if (run_.chain.empty()) {
      run_.chain = labels.substr(3, 2);
      run_.flanked = are_neighbours(labels, before_);
    }
    const std::string name = labels.substr(0, 3);
    run_.short_name |= name.find(' ') != std::string::npos;
    if (before_.compare(0, 5, labels, 0, 5) != 0 && is_amino_acid(name)) {
      run_.amino_acids.insert(name);
      run_.all_known = run_.all_known && is_named_with_four(labels.substr(0, 4));
    }
  }
  before_ = labels;
}

void LabelColumns::end_run(std::string_view next) {
  if (run_.chain.empty())
    return;
  const bool flanked = run_.flanked || are_neighbours(before_, next);
  // Without a letter in column 22 none of the usual programs means a chain.
  const size_t wanted = run_.chain[1] == ' ' ? 2 : 1;
  if (run_.short_name || (!flanked && !run_.all_known && run_.amino_acids.size() >= wanted))
    two_letters_.insert(run_.chain);
  run_ = {};
}

void LabelColumns::finish() {
  end_run({});
}

AtomLabels LabelColumns::of(std::string_view line) const {
  AtomLabels labels;
  const auto field = [&](size_t at, size_t width) {
    return at < line.size() ? trimmed(line.substr(at, width)) : std::string_view{};
  };
  if (column(line, segment_at) != '.') // the decimals of a charge in PDBQT
    labels.segment = field(segment_at, 4);
  if (is_wider(line)) {
    const std::vector<std::string_view> word = words(line.substr(residue_at, 10));
    labels.residue = word[0];
    labels.number = word[1];
  } else {
    const char chain = column(line, chain_at);
    // Ligands, ions and waters in chains of their own have two letters where the polymers' chains have.
    const bool two = column(line, fourth_at) != ' ' &&
                     (two_letters_.count(columns(line, fourth_at, 2)) != 0 ||
                      (chain != ' ' && std::any_of(two_letters_.begin(), two_letters_.end(),
                                                   [](const std::string& c) { return c[1] != ' '; })));
    labels.residue = field(residue_at, two ? 3 : 4);
    labels.chain = two ? field(fourth_at, 2) : field(chain_at, 1);
    labels.number = line.substr(number_at, 5);
  }
  if (labels.chain.empty() && !labels.segment.empty() && !is_line_number(line)) {
    labels.chain = labels.segment;
    labels.chain_of_segment = true;
  }
  return labels;
}

ResidueNumbers::Number ResidueNumbers::read(std::string_view field) {
  constexpr int most_decimal = 9999, most_missing = 1000;
  std::string text(field.substr(0, 5));
  text.resize(5, ' ');
  const std::string_view four = std::string_view(text).substr(0, 4), number = trimmed(four);
  const char code = text[4] == '\t' ? ' ' : text[4];
  const auto result = [&](int value, char insertion) {
    before_ = value;
    return Number{gemmi::SeqId(value, insertion), true};
  };
  if (are_all(four, is_hexadecimal) && !is_digit(code)) {
    int value = 0;
    std::from_chars(four.data(), four.data() + four.size(), value, 16);
    const bool has_letter = !are_all(four, is_digit);
    const bool is_small = std::any_of(four.begin(), four.end(), [](char c) { return c >= 'a'; });
    // Digits alone may be decimal, capitals hybrid-36: these must follow the number before.
    const bool follows = before_ > most_decimal
                             ? value >= before_ && value - before_ <= most_missing
                             : before_ > most_decimal - 10 && value > most_decimal && value - before_ <= 10;
    if (value > most_decimal &&
        (follows || (has_letter && is_digit(four[0])) || (is_small && before_ > most_decimal))) {
      ++hexadecimal_;
      return result(value, code);
    }
  }
  if (are_all(four, is_digit) && is_digit(code))
    return result(decimal_or(text, 0), ' ');
  if (number.size() == 4 && is_capital(number[0]) &&
      are_all(number, [](char c) { return is_digit(c) || is_capital(c); })) {
    int value = 0;
    std::from_chars(number.data(), number.data() + number.size(), value, 36);
    return result(value - 10 * 36 * 36 * 36 + most_decimal + 1, code);
  }
  if (number.empty()) // none
    return {gemmi::SeqId(gemmi::SeqId::OptionalNum(), code), true};
  std::string_view digits = number;
  if (digits[0] == '-' || digits[0] == '+')
    digits.remove_prefix(1);
  if (!digits.empty() && are_all(digits, is_digit) && number != "-999") {
    const int value = decimal_or(digits, 0);
    return result(number[0] == '-' ? -value : value, code);
  }
  // As gemmi reads it.
  Number none{gemmi::SeqId(gemmi::SeqId::OptionalNum(), code), false};
  if (text[0] >= 'A')
    none.id.num = static_cast<int>(std::strtol(std::string(four).c_str(), nullptr, 36)) - 466560 + 10000;
  else
    none.id.num = static_cast<int>(std::strtol(std::string(number).c_str(), nullptr, 10));
  return none;
}

} // namespace molmesh::formats
