// atom_site.cpp — what would make gemmi throw without saying where, or overflow, is refused here, by line.
#include "formats/pdb/atom_site.hpp"
#include "base/error.hpp"
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/parse.hpp"
#include "molecule/limits.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <cmath>
#include <gemmi/numb.hpp>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;

/// The line of a row when the rows stand one a line, otherwise the loop's.
int64_t line_of_row(std::string_view text, int64_t loop_line, size_t tags, size_t row, const std::string& value) {
  const int64_t guess = loop_line + static_cast<int64_t>(tags + row) + 1;
  int64_t result = std::max<int64_t>(loop_line, 1); // JSON knows no lines
  for_each_line(text, [&](std::string_view line, int64_t number) {
    if (number == guess && line.find(value) != std::string_view::npos)
      result = number;
  });
  return result;
}

/// gemmi's integers overflow unnoticed: nine digits at most.
bool is_integer(std::string_view value) {
  if (!value.empty() && (value[0] == '-' || value[0] == '+'))
    value.remove_prefix(1);
  return !value.empty() && value.size() <= 9 && value.find_first_not_of("0123456789") == std::string_view::npos;
}

} // namespace

void check_coordinates(const cif::Loop& loop, const AtomColumns& columns, std::string_view text,
                       const std::string& where, int64_t line) {
  const size_t width = loop.width();
  for (const char* axis : {"Cartn_x", "Cartn_y", "Cartn_z"}) {
    const auto column = static_cast<size_t>(columns.find(axis));
    for (size_t i = column, row = 0; i < loop.values.size(); i += width, ++row)
      if (!(std::abs(cif::as_number(loop.values[i])) <= largest_coordinate))
        fail_input(where + ":" + std::to_string(line_of_row(text, line, loop.tags.size(), row, loop.values[i])) +
                   ": found " + in_quotes(loop.values[i]) + " as " + axis + ", expected a coordinate (Å)");
  }
}

void check_integers(cif::Loop& loop, const AtomColumns& columns, std::string_view text, const std::string& where,
                    int64_t line) {
  const auto each = [&](const char* name, auto take) {
    if (const int column = columns.find(name); column >= 0)
      for (size_t i = static_cast<size_t>(column), row = 0; i < loop.values.size(); i += loop.width(), ++row)
        take(loop.values[i], row);
  };
  for (const char* name : {"auth_seq_id", "label_seq_id"})
    each(name, [&](const std::string& value, size_t row) {
      std::string_view number = value;
      if (name[0] == 'a' && number.size() > 1 && number.back() > '9')
        number.remove_suffix(1);
      if (!cif::is_null(value) && !is_integer(number))
        fail_input(where + ":" + std::to_string(line_of_row(text, line, loop.tags.size(), row, value)) +
                   ": found " + in_quotes(value) + " as " + name + ", expected an integer");
    });
  each("pdbx_formal_charge", [](std::string& value, size_t) { value = "?"; });
}

void check_sequence(const cif::Item& item, const std::string& where) {
  const std::string tag = "_entity_poly_seq.num";
  const auto check = [&](const std::string& value) {
    if (!cif::is_null(value) && !is_integer(value))
      fail_input(where + ": found " + in_quotes(value) + " as " + tag + ", expected an integer");
  };
  if (item.type == cif::ItemType::Pair && item.pair[0] == tag)
    check(item.pair[1]);
  if (item.type == cif::ItemType::Loop)
    if (const int column = item.loop.find_tag(tag); column >= 0)
      for (size_t i = static_cast<size_t>(column); i < item.loop.values.size(); i += item.loop.width())
        check(item.loop.values[i]);
}

int64_t name_elements(cif::Loop& loop, const AtomColumns& columns, ElementGuesses& guesses) {
  const auto element = static_cast<size_t>(columns.find("type_symbol"));
  const auto residue = static_cast<size_t>(columns.find("label_comp_id"));
  const int label = columns.find("label_atom_id");
  const auto atom = static_cast<size_t>(label < 0 ? columns.find("auth_atom_id") : label);
  int64_t named = 0;
  for (size_t row = 0; row < loop.values.size(); row += loop.width()) {
    std::string& symbol = loop.values[row + element];
    if (const auto end = std::find_if_not(symbol.begin(), symbol.end(), is_letter); end != symbol.begin())
      symbol.erase(end, symbol.end()); // "O1-": a charge behind it
    if (cif::is_null(symbol)) {
      const std::string name = cif::as_string(loop.values[row + atom]),
                        of = cif::as_string(loop.values[row + residue]);
      const gemmi::Element named_as = named_element(name, of);
      guesses.add(name, of, named_as);
      symbol = named_as.name();
      ++named;
    }
  }
  return named;
}

} // namespace molmesh::formats
