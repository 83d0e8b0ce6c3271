// xyzr.cpp — MSMS' .xyzr: lines x y z radius (Å), in .xyzrn with 1 NAME_RESIDUE_NUMBER behind.
#include "base/error.hpp"
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/structure_builder.hpp"
#include "molecule/limits.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace molmesh::formats {
namespace {

struct Label {
  std::string name = "X", residue = "UNK";
  int number = 1;
};

/// "CA_ALA_7"
std::optional<Label> read_label(std::string_view text) {
  const size_t last = text.rfind('_'), first = text.find('_');
  if (first == std::string_view::npos || first == last || first == 0)
    return std::nullopt;
  Label label{std::string(text.substr(0, first)), std::string(text.substr(first + 1, last - first - 1)), 0};
  const auto [end, error] = std::from_chars(text.data() + last + 1, text.data() + text.size(), label.number);
  if (error != std::errc() || end != text.data() + text.size() || label.residue.empty())
    return std::nullopt;
  return label;
}

bool is_comment(std::string_view line) {
  line = trimmed(line);
  return line.empty() || line[0] == '#';
}

} // namespace

bool looks_like_xyzr(std::string_view text) {
  bool first = true, sphere = false;
  for_each_line(text.substr(0, 4096), [&](std::string_view line, int64_t) {
    if (!first || is_comment(line))
      return;
    first = false;
    const std::vector<std::string_view> word = words(line);
    sphere = (word.size() == 4 || (word.size() == 6 && read_label(word[5]))) &&
             std::all_of(word.begin(), word.begin() + 4,
                         [](std::string_view w) { return signed_decimal(w).has_value(); });
  });
  return sphere;
}

Parsed parse_xyzr(std::string_view text, const std::string& file) {
  Parsed parsed;
  parsed.format = "XYZR";
  StructureBuilder builder(parsed.structure);
  builder.open_model("1");
  parsed.pqr.reserve(static_cast<size_t>(std::count(text.begin(), text.end(), '\n')));
  int64_t last = 1, large = 0;
  bool named = false;
  for_each_line(text, [&](std::string_view line, int64_t number) {
    last = number;
    if (is_comment(line)) {
      parsed.passed_over["#"] += !trimmed(line).empty();
      return;
    }
    const std::vector<std::string_view> word = words(line);
    std::array<double, 4> value{};
    for (size_t i = 0; i < value.size(); ++i) {
      const std::optional<double> v = i < word.size() ? signed_decimal(word[i]) : std::nullopt;
      if (!v || std::abs(*v) > (i == 3 ? largest_radius : largest_coordinate) || (i == 3 && *v < 0))
        fail_input(file + ":" + std::to_string(number) + ": found " + in_quotes(line) +
                   ", expected x, y, z and a radius ≥ 0 (Å)");
      value[i] = *v;
    }
    const std::optional<Label> written = word.size() >= 6 ? read_label(word[5]) : std::nullopt;
    const Label label = written.value_or(Label{});
    named |= written.has_value();
    pdb::Atom atom;
    atom.name = builder.label(label.name);
    atom.element = written ? named_element(label.name, label.residue) : gemmi::Element(gemmi::El::X);
    atom.pos = {value[0], value[1], value[2]};
    atom.serial = static_cast<int>(parsed.pqr.size());
    large += value[3] > believed_radius;
    parsed.pqr.push_back({std::numeric_limits<double>::quiet_NaN(), value[3]});
    builder.add("", {gemmi::SeqId(label.number, ' '), {}, builder.label(label.residue)}, false, true, atom);
  });
  if (parsed.pqr.empty())
    fail_input(file + ":" + std::to_string(last) + ": found no sphere, expected lines x y z radius (Å)");
  builder.finish();
  if (!named)
    parsed.notes.emplace_back("the file names no atoms and residues: all are one residue");
  if (large > 0)
    parsed.notes.push_back(note_of_large_radii(large));
  return parsed;
}

} // namespace molmesh::formats
