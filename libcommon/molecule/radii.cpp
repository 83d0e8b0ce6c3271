// radii.cpp — holds the table of radii and reads a user's own.
#include "molecule/radii.hpp"
#include "base/error.hpp"
#include "molecule/limits.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <istream>
#include <vector>

namespace molmesh {
namespace {

struct Entry {
  std::string_view element;
  double radius;
};

// Bondi 1964, table I and its text for metals.
constexpr Entry bondi[] = {
    {"H", 1.20},  {"HE", 1.40}, {"LI", 1.82}, {"C", 1.70},  {"N", 1.55},  {"O", 1.52},  {"F", 1.47},  {"NE", 1.54},
    {"NA", 2.27}, {"MG", 1.73}, {"SI", 2.10}, {"P", 1.80},  {"S", 1.80},  {"CL", 1.75}, {"AR", 1.88}, {"K", 2.75},
    {"NI", 1.63}, {"CU", 1.40}, {"ZN", 1.39}, {"GA", 1.87}, {"AS", 1.85}, {"SE", 1.90}, {"BR", 1.85}, {"KR", 2.02},
    {"PD", 1.63}, {"AG", 1.72}, {"CD", 1.58}, {"IN", 1.93}, {"SN", 2.17}, {"TE", 2.06}, {"I", 1.98},  {"XE", 2.16},
    {"PT", 1.75}, {"AU", 1.66}, {"HG", 1.55}, {"TL", 1.96}, {"PB", 2.02}, {"U", 1.86}};

// Mantina et al. 2009, table 12.
constexpr Entry mantina[] = {{"BE", 1.53}, {"B", 1.92},  {"AL", 1.84}, {"CA", 2.31}, {"GE", 2.11}, {"RB", 3.03},
                             {"SR", 2.49}, {"SB", 2.06}, {"CS", 3.43}, {"BA", 2.68}, {"BI", 2.07}, {"PO", 1.97},
                             {"AT", 2.02}, {"RN", 2.20}, {"FR", 3.48}, {"RA", 2.83}};

std::string upper(std::string_view text) {
  std::string s(text);
  for (char& c : s)
    if (c >= 'a' && c <= 'z')
      c = static_cast<char>(c - 'a' + 'A');
  return s;
}

std::string atom_key(std::string_view residue, std::string_view atom) {
  std::string key = upper(residue);
  key += ' ';
  return key += upper(atom);
}

} // namespace

std::optional<double> bondi_radius(std::string_view element) {
  std::string symbol = upper(element);
  if (symbol == "D")
    symbol = "H";
  for (const Entry& e : bondi)
    if (e.element == symbol)
      return e.radius;
  for (const Entry& e : mantina)
    if (e.element == symbol)
      return e.radius;
  return std::nullopt;
}

std::optional<double> Radii::find(std::string_view residue, std::string_view atom, std::string_view element) const {
  if (!atom_.empty())
    for (const std::string_view scope : {residue, std::string_view("*")})
      if (const auto found = atom_.find(atom_key(scope, atom)); found != atom_.end())
        return found->second;
  for (std::string symbol = upper(element); !element_.empty(); symbol = "H") {
    if (const auto found = element_.find(symbol); found != element_.end())
      return found->second;
    if (symbol != "D")
      break;
  }
  return bondi_radius(element);
}

void Radii::set_element(std::string_view element, double radius) {
  element_[upper(element)] = radius;
}

void Radii::set_atom(std::string_view residue, std::string_view atom, double radius) {
  atom_[atom_key(residue, atom)] = radius;
}

Radii read_radii(std::istream& in, const std::string& file) {
  Radii radii;
  read_lines(in, file, [&](const std::string& line, const std::string& where) {
    const std::vector<std::string_view> word = words(line);
    if (word.size() != 2 && word.size() != 3)
      fail_input(where + ": found " + std::to_string(word.size()) +
                 " fields, expected ELEMENT RADIUS or RESIDUE ATOM RADIUS");
    const std::optional<double> radius = decimal(word.back());
    if (!radius || *radius <= 0 || *radius > largest_radius)
      fail_input(where + ": found radius '" + std::string(word.back()) +
                 "', expected a number > 0, at most 10000 (Å)");
    if (word.size() == 3 && word[1].find('.') != std::string_view::npos && decimal(word[1]))
      fail_input(where + ": found atom '" + std::string(word[1]) +
                 "', expected ELEMENT RADIUS or RESIDUE ATOM RADIUS");
    if (word.size() == 2)
      radii.set_element(word[0], *radius);
    else
      radii.set_atom(word[0], word[1], *radius);
  });
  return radii;
}

} // namespace molmesh
