// selection_advice.cpp — looks at the field of residues and writes it anew.
#include "formats/pdb/selection_advice.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/selection.hpp"
#include "molecule/grouping.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <cstdlib>
#include <vector>

namespace molmesh::formats {
namespace {

using std::string_view;

/// As "ANS" or "SO4". Numbers, and numbers with an insertion code, are none.
bool is_name(string_view s) {
  constexpr size_t most = 5;
  const auto letters = std::count_if(s.begin(), s.end(), is_letter);
  return s.size() <= most && letters > 0 &&
         std::all_of(s.begin(), s.end(), [](char c) { return is_letter(c) || is_digit(c); }) &&
         !(letters == 1 && is_digit(s[0]) && is_letter(s.back()));
}

/// "57" of "57" or "HIS57", "57.A" of "HIS57A"; empty: neither.
std::string number_of(string_view s) {
  const bool named = s.size() > 3 && is_letter(s[0]) && is_letter(s[1]) && is_letter(s[2]);
  if (named)
    s.remove_prefix(3);
  const size_t digits = static_cast<size_t>(std::find_if_not(s.begin(), s.end(), is_digit) - s.begin());
  const string_view code = s.substr(digits);
  if (digits == 0 || code.size() > 1 || (!code.empty() && !(named && is_letter(code[0]))))
    return "";
  return std::string(s.substr(0, digits)) + (code.empty() ? "" : "." + std::string(code));
}

std::string range_of(string_view s) {
  const size_t dash = s.find('-');
  const std::string first = number_of(s.substr(0, dash));
  if (dash == s.npos || first.empty())
    return first;
  const std::string last = number_of(s.substr(dash + 1));
  return last.empty() ? "" : first + "-" + last;
}

std::vector<string_view> parts_of(string_view list) {
  std::vector<string_view> parts;
  for (;;) {
    const size_t comma = list.find(',');
    parts.push_back(trimmed(list.substr(0, comma)));
    if (comma == list.npos)
      return parts;
    list.remove_prefix(comma + 1);
  }
}

struct Meant {
  const char* expected = nullptr; ///< null: not told
  std::string field;
};

Meant meant(string_view field) {
  const bool all_but = !field.empty() && field[0] == '!';
  const string_view list = field.substr(all_but ? 1 : 0);
  const bool enclosed = list.size() > 2 && list[0] == '(' && list.back() == ')';
  const std::vector<string_view> parts = parts_of(enclosed ? list.substr(1, list.size() - 2) : list);
  std::string numbers, names;
  bool all_numbers = true, all_names = true;
  for (const string_view part : parts) {
    const std::string comma = names.empty() ? "" : ",", range = range_of(part);
    all_numbers &= !range.empty();
    all_names &= is_name(part);
    numbers += comma + range;
    names += comma + std::string(part);
  }
  if (all_but && all_names)
    return {"'!' within the parentheses", "(!" + names + ")"};
  if (!all_but && !enclosed && all_numbers && numbers != names)
    return {"numbers of residues without names", numbers};
  if (!all_but && !enclosed && all_names)
    return {"names of residues in parentheses", "(" + names + ")"};
  return {};
}

} // namespace

void ResiduesThere::add(const std::string& chain, const std::string& name, int number) {
  constexpr size_t most = 4;
  if (!number_) {
    Kind& kind = kind_[name.substr(0, name.rfind(':'))];
    if (kind.residues++ == 0)
      kind.first = residue_in_selection(chain, name);
    return;
  }
  const int64_t distance = std::abs(int64_t{number} - *number_);
  if (nearest_.size() == most && nearest_.back().first <= distance)
    return;
  const auto at = std::find_if(nearest_.begin(), nearest_.end(), [&](const auto& n) { return n.first > distance; });
  nearest_.insert(at, {distance, residue_in_selection(chain, name)});
  nearest_.resize(std::min(nearest_.size(), most));
}

std::string ResiduesThere::text() const {
  constexpr size_t most = 6;
  std::vector<std::pair<int64_t, std::string>> some = nearest_;
  for (const auto& [name, kind] : kind_)
    some.push_back({kind.residues, kind.first});
  std::stable_sort(some.begin(), some.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string text;
  for (size_t i = 0; i < std::min(some.size(), most); ++i)
    text += (i == 0 ? "; residues there: " : ", ") + some[i].second;
  return text + (some.size() > most ? ", …" : "");
}

std::string selection_advice(const std::string& selection) {
  if (selection.empty() || selection.find('"') != selection.npos)
    return "";
  const int omitted = gemmi::impl::determine_omitted_cid_fields(selection);
  size_t begin = 0; // of the residues
  for (int slashes = omitted == 0 ? 3 : omitted == 1 ? 1 : 0; slashes > 0; --slashes) {
    begin = selection.find('/', begin) + 1;
    if (begin == 0)
      return "";
  }
  const size_t end = std::min(selection.find_first_of("/;", begin), selection.size());
  if (std::count(selection.begin() + static_cast<std::ptrdiff_t>(end), selection.end(), '/') > 1)
    return ""; // behind the residues are atoms, and nothing else
  const Meant m = omitted == 3 ? Meant{} : meant(string_view(selection).substr(begin, end - begin));
  if (!m.expected)
    return "";
  const std::string before = omitted == 2 ? "//*/" : selection.substr(0, begin);
  return std::string(m.expected) + ": " + in_quotes(before + m.field + selection.substr(end));
}

} // namespace molmesh::formats
