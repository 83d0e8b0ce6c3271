// remark350.cpp — BIOMOLECULE, APPLY THE FOLLOWING TO CHAINS, BIOMT.
#include "formats/pdb/remark350.hpp"
#include "base/error.hpp"
#include "molecule/words.hpp"

namespace molmesh::formats {
namespace {

/// What follows the colon of a heading, when `text` is one.
bool heading(std::string_view text, std::string_view name, std::string_view& value) {
  const size_t colon = text.find(':');
  if (colon == std::string_view::npos || trimmed(text.substr(0, colon)) != name)
    return false;
  value = trimmed(text.substr(colon + 1));
  return true;
}

void add_chains(std::string_view list, std::vector<std::string>& chains) {
  std::string spaced(list);
  for (char& c : spaced)
    if (c == ',')
      c = ' ';
  for (const std::string_view chain : words(spaced))
    chains.emplace_back(chain == "NULL" ? std::string_view("_") : chain);
}

} // namespace

void Remark350::finish() const {
  if (rows_ > 0)
    fail_input(where_ + ": found operator " + serial_ + " without BIOMT" + "123"[rows_] + ", expected three rows");
}

void Remark350::take(std::string_view line, const std::string& where) {
  const std::string_view text = trimmed(line.substr(std::min<size_t>(line.size(), 10)));
  std::string_view value;
  if (heading(text, "BIOMOLECULE", value)) {
    finish();
    assemblies.emplace_back(std::string(value.substr(0, value.find_first_of(", "))));
    return;
  }
  if (assemblies.empty())
    return;
  std::vector<gemmi::Assembly::Gen>& generators = assemblies.back().generators;
  if (heading(text, "APPLY THE FOLLOWING TO CHAINS", value)) {
    finish();
    add_chains(value, generators.emplace_back().chains);
  } else if (heading(text, "AND CHAINS", value) && !generators.empty()) {
    add_chains(value, generators.back().chains);
  } else if (text.substr(0, 5) == "BIOMT" && !generators.empty()) {
    const std::vector<std::string_view> word = words(text);
    const auto row = static_cast<size_t>(rows_);
    bool good =
        word.size() == 6 && word[0].size() == 6 && word[0][5] == "123"[row] && (rows_ == 0 || word[1] == serial_);
    for (size_t i = 0; good && i < 4; ++i) {
      const std::optional<double> number = signed_decimal(word[2 + i]);
      good = number.has_value();
      if (!good)
        break;
      (i < 3 ? transform_.mat[row][i] : transform_.vec.at(rows_)) = *number;
    }
    if (!good)
      fail_input(where + ": found '" + std::string(text) + "', expected BIOMT" + "123"[row] +
                 (rows_ == 0 ? " SERIAL" : " " + serial_) + " and four numbers");
    serial_ = word[1];
    where_ = where;
    if (++rows_ < 3)
      return;
    rows_ = 0;
    generators.back().operators.emplace_back();
    generators.back().operators.back().name = word[1];
    generators.back().operators.back().transform = transform_;
  }
}

} // namespace molmesh::formats
