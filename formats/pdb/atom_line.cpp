// atom_line.cpp — columns taken out where a field before them was too wide.
#include "formats/pdb/atom_line.hpp"
#include "molecule/limits.hpp"
#include "molecule/words.hpp"
#include <cmath>

namespace molmesh::formats {
namespace {

constexpr size_t coordinates_end = first_x + 3 * coordinate_width;

bool is_standard(std::string_view line) {
  for (size_t at = first_x; at < coordinates_end; at += coordinate_width)
    if (!is_coordinate(line.substr(at, coordinate_width)))
      return false;
  return true;
}

bool is_pushed(std::string_view line) {
  return line.size() > coordinates_end && is_digit(line[10]) && is_digit(line[11]) && !is_standard(line);
}

bool is_shifted(std::string_view line) {
  if (line.size() < coordinates_end + 1 || line[first_x] != ' ')
    return false;
  for (size_t axis = 0; axis < 3; ++axis) {
    const std::string_view field = line.substr(first_x + 1 + axis * coordinate_width, coordinate_width);
    if (field[4] != '.' || !is_coordinate(field))
      return false;
  }
  return !is_standard(line);
}

} // namespace

bool is_coordinate(std::string_view field) {
  const std::optional<double> value = signed_decimal(trimmed(field));
  return value && std::abs(*value) <= largest_coordinate;
}

AtomLine in_columns(std::string_view line, std::string& room, bool coordinates) {
  AtomLine a{line};
  const auto without_column = [&](size_t column) {
    if (a.text.data() != room.data())
      room = a.text;
    room.erase(column, 1);
    a.text = room;
  };
  for (; is_pushed(a.text); a.pushed = true)
    without_column(11);
  a.shifted = coordinates && is_shifted(a.text);
  if (a.shifted)
    without_column(first_x);
  return a;
}

} // namespace molmesh::formats
