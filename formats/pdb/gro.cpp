// gro.cpp — GROMACS' .gro: frames of a title, a number of atoms, their lines and a box; nm become Å.
#include "base/error.hpp"
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/structure_builder.hpp"
#include "molecule/limits.hpp"
#include "molecule/words.hpp"
#include <charconv>
#include <cmath>

namespace molmesh::formats {
namespace {

constexpr size_t first_coordinate = 20;

/// The width of a coordinate: from one decimal point to the next, whatever the precision. 0: the line has not two.
size_t width_of(std::string_view line) {
  const size_t first = line.find('.', first_coordinate);
  const size_t second = first == std::string_view::npos ? first : line.find('.', first + 1);
  return second == std::string_view::npos ? 0 : second - first;
}

std::optional<int64_t> integer(std::string_view text) {
  text = trimmed(text);
  int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size())
    return std::nullopt;
  return value;
}

/// In Å, without the rounding of a multiplication.
std::optional<double> coordinate(std::string_view line, size_t axis, size_t width) {
  const size_t at = first_coordinate + axis * width;
  if (at + width > line.size() + 1 || at >= line.size())
    return std::nullopt;
  const std::string_view field = trimmed(line.substr(at, width));
  return field.empty() || !signed_decimal(field) ? std::nullopt : signed_decimal(std::string(field) + "e1");
}

class GroLines {
public:
  GroLines(const std::string& file, Parsed& parsed) : file_(file), parsed_(parsed), builder_(parsed.structure) {}

  void take(std::string_view line, int64_t number) {
    line_ = number;
    switch (expected_) {
    case Line::title:
      expected_ = Line::count;
      break;
    case Line::count: {
      if (blank_behind_frame_ && trimmed(line).empty()) // blank lines at the end
        break;
      const std::optional<int64_t> n = integer(line);
      if (!n || *n < 0)
        refuse("found " + in_quotes(line) + ", expected the number of atoms (GROMACS)");
      left_ = *n;
      builder_.open_model(std::to_string(parsed_.structure.models.size() + 1));
      if (parsed_.structure.models.size() > most_models)
        refuse("found more than " + std::to_string(most_models) + " frames, expected fewer");
      expected_ = left_ > 0 ? Line::atom : Line::box;
      break;
    }
    case Line::atom:
      atom(line);
      if (--left_ == 0)
        expected_ = Line::box;
      break;
    case Line::box:
      ++parsed_.passed_over["box"];
      expected_ = Line::title;
      break;
    }
    blank_behind_frame_ = expected_ == Line::count && trimmed(line).empty();
  }

  void finish() {
    if (atoms_ == 0 || expected_ == Line::atom)
      refuse("found the end " +
             (atoms_ == 0 ? std::string("without an atom") : std::to_string(left_) + " atoms early") +
             ", expected a structure (GROMACS)");
    builder_.finish();
    if (guesses_.all() > 0)
      parsed_.notes.push_back("atoms without an element, taken from the name: " + std::to_string(guesses_.all()));
    guesses_.report(parsed_);
    if (builder_.restarted() > 0)
      parsed_.notes.push_back("residues whose number has started again, kept apart: " +
                              std::to_string(builder_.restarted()));
  }

private:
  [[noreturn]] void refuse(const std::string& what) const {
    fail_input(file_ + ":" + std::to_string(std::max<int64_t>(line_, 1)) + ": " + what);
  }

  void atom(std::string_view line) {
    const size_t width = width_of(line);
    pdb::Atom atom;
    double* const axis[] = {&atom.pos.x, &atom.pos.y, &atom.pos.z};
    for (size_t a = 0; a < 3; ++a) {
      const std::optional<double> value = width > 0 ? coordinate(line, a, width) : std::nullopt;
      if (!value || std::abs(*value) > largest_coordinate)
        refuse("found " + in_quotes(line) +
               ", expected an atom (GROMACS): number, residue, name, serial, x, y, z (nm)");
      *axis[a] = *value;
    }
    const std::optional<int64_t> number = integer(line.substr(0, 5));
    if (!number)
      refuse("found residue number " + in_quotes(line.substr(0, 5)) + ", expected an integer");
    const std::string_view residue = trimmed(line.substr(5, 5));
    atom.name = builder_.label(trimmed(line.substr(10, 5)));
    atom.element = named_element(atom.name.str(), residue);
    atom.serial = static_cast<int>(atoms_++);
    guesses_.add(atom.name.str(), residue, atom.element);
    builder_.add("", {gemmi::SeqId(static_cast<int>(*number), ' '), {}, builder_.label(residue)}, false, true,
                 atom);
  }

  enum class Line { title, count, atom, box } expected_ = Line::title;
  const std::string& file_;
  Parsed& parsed_;
  StructureBuilder builder_;
  ElementGuesses guesses_;
  int64_t line_ = 0, atoms_ = 0, left_ = 0;
  bool blank_behind_frame_ = false;
};

} // namespace

bool looks_like_gro(std::string_view text) {
  std::string_view line[3];
  for_each_line(text.substr(0, 4096), [&](std::string_view l, int64_t number) {
    if (number <= 3)
      line[number - 1] = l;
  });
  const size_t width = width_of(line[2]);
  return integer(line[1]) && width > 0 && integer(line[2].substr(0, 5)) && coordinate(line[2], 0, width) &&
         coordinate(line[2], 1, width) && coordinate(line[2], 2, width);
}

Parsed parse_gro(std::string_view text, const std::string& file) {
  Parsed parsed;
  parsed.format = "GROMACS";
  GroLines lines(file, parsed);
  for_each_line(text, [&](std::string_view line, int64_t number) { lines.take(line, number); });
  lines.finish();
  return parsed;
}

} // namespace molmesh::formats
