// pqr.cpp — PQR: atoms with charge and radius. Fields between blanks, as APBS reads them; where coordinates run
// together, the columns of the PDB format. GROMACS and Open Babel add the element.
#include "base/error.hpp"
#include "base/shortest.hpp"
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/model_names.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/passed_over.hpp"
#include "molecule/limits.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <gemmi/resinfo.hpp>
#include <set>
#include <unordered_map>

namespace molmesh::formats {
namespace {

struct PqrAtom {
  std::string name, residue, chain;
  int number = 1;
  char insertion = ' ';
  double x, y, z, charge, radius;
  gemmi::Element element = gemmi::El::X;
};

/// The columns of GROMACS (-mead), "%-6s%5d %-4.4s%4.4s%c%4d %8.3f %8.3f %8.3f %6.2f %6.2f": names, chain and
/// number stand one column before those of the PDB format and touch where they are wide.
bool has_gromacs_columns(std::string_view line) {
  constexpr std::array<size_t, 5> points = {30, 39, 48, 56, 63}, blanks = {25, 34, 43, 52, 59};
  return line.size() >= 66 &&
         std::all_of(points.begin(), points.end(), [&](size_t at) { return line[at] == '.'; }) &&
         std::all_of(blanks.begin(), blanks.end(), [&](size_t at) { return line[at] == ' '; });
}

class PqrLines {
public:
  PqrLines(const std::string& file, Parsed& parsed, bool believed)
      : file_(file), parsed_(parsed), believed_(believed), passed_over_(file) {}

  /// First of every line: do residues' names of four letters end with their chain's?
  void look(std::string_view line) {
    if (!is_atom_record(line))
      return;
    std::vector<std::string_view> word = words(line.substr(is_record(line, "HETATM") ? 6 : 4));
    take_element(word);
    if (word.size() != 9 || word[2].size() > 4)
      return;
    const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(std::string(word[2].substr(0, 3)));
    if (!info.is_amino_acid() || !info.is_standard())
      return;
    if (word[2].size() == 4)
      glued_.emplace(word[2].substr(0, 3));
    apart_ |= word[2].size() < 4;
  }

  void take(std::string_view line, int64_t number) {
    line_ = number;
    if (ended_)
      after_end_ += is_atom_record(line);
    else if (is_atom_record(line))
      add(atom(line), is_record(line, "HETATM"));
    else if (is_record(line, "MODEL"))
      open_model(line);
    else if (is_record(line, "ENDMDL"))
      in_model_ = false;
    else if (is_record(line, "END") && (line.size() == 3 || line[3] == ' '))
      ended_ = true;
    else
      passed_over_.take(line, number);
  }

  void finish() const {
    passed_over_.report(parsed_);
    if (large_ > 0)
      parsed_.notes.push_back(note_of_large_radii(large_));
    if (after_end_ > 0)
      parsed_.notes.push_back("atom lines after END, not read: " + std::to_string(after_end_));
    if (parsed_.pqr.empty())
      fail_input(file_ + ":" + std::to_string(std::max<int64_t>(line_, 1)) +
                 ": found the end without an ATOM or HETATM record, expected PQR");
  }

private:
  [[noreturn]] void refuse(const std::string& what) const {
    fail_input(file_ + ":" + std::to_string(line_) + ": " + what);
  }

  void open_model(std::string_view record) {
    in_model_ = true;
    parsed_.structure.models.emplace_back(names_.next(record));
    if (parsed_.structure.models.size() > most_models)
      refuse("found more than " + std::to_string(most_models) + " models, expected fewer");
    chain_.clear();
  }

  PqrAtom atom(std::string_view line) const {
    if (has_gromacs_columns(line))
      return columns(line, 1);
    const size_t record = is_record(line, "HETATM") ? 6 : 4;
    std::vector<std::string_view> word = words(line.substr(record));
    PqrAtom a;
    a.element = take_element(word);
    if (word.size() >= 5 + 3) {
      const size_t head = word.size() - 5;
      // In the PDB format's columns: "HD11ALEU", or "POPCA", the last letter the chain's in column 22.
      const auto ends_in_22 = [&](std::string_view w) { return w.data() + w.size() == line.data() + 22; };
      const bool names_run_together =
          has_pdb_columns(line) && (word[1].size() > 4 || (word[2].size() == 5 && ends_in_22(word[2])));
      if (!names_run_together && numbers({word.begin() + static_cast<std::ptrdiff_t>(head), word.end()}, a) &&
          labels(word, head, a))
        return a;
    }
    return columns(line, 0);
  }

  /// x y z charge radius
  static bool numbers(const std::vector<std::string_view>& word, PqrAtom& a) {
    double* const value[] = {&a.x, &a.y, &a.z, &a.charge, &a.radius};
    for (size_t i = 0; i < 5; ++i) {
      const std::optional<double> v = i < word.size() ? signed_decimal(word[i]) : std::nullopt;
      if (!v)
        return false;
      *value[i] = *v;
    }
    return true;
  }

  /// serial name residue [chain] number, where chain and number may run together.
  bool labels(const std::vector<std::string_view>& word, size_t count, PqrAtom& a) const {
    if (count < 3 || count > 5)
      return false;
    a.name = word[1];
    a.residue = count == 3 ? std::string_view("UNK") : word[2];
    std::string_view number = word[count - 1];
    if (count == 5)
      a.chain = word[3];
    else if (count == 4 && number.size() > 1 && !is_digit(number[0]) && number[0] != '-') {
      a.chain = number.substr(0, 1);
      number.remove_prefix(1);
    } else if (count == 4 && a.residue.size() == 4 && glued_.size() > 1 && !apart_) {
      a.chain = a.residue.substr(3);
      a.residue.resize(3);
    }
    return residue_number(number, a);
  }

  static bool residue_number(std::string_view text, PqrAtom& a) {
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), a.number);
    if (error != std::errc{})
      return false;
    const size_t left = static_cast<size_t>(text.data() + text.size() - rest);
    if (left == 1 && is_letter(*rest))
      a.insertion = *rest;
    return left == 0 || a.insertion != ' ';
  }

  /// before: columns by which residue, chain and number stand before those of the PDB format, each coordinate
  /// behind a blank of its own.
  PqrAtom columns(std::string_view line, size_t before) const {
    PqrAtom a;
    const auto field = [&](size_t at, size_t width) {
      return at < line.size() ? trimmed(line.substr(at, width)) : std::string_view{};
    };
    const size_t x = before > 0 ? 26 : 30, width = before > 0 ? 9 : 8;
    std::vector<std::string_view> word = {field(x, 8), field(x + width, 8), field(x + 2 * width, 8)};
    for (const std::string_view w : words(field(x + 3 * width, line.size())))
      word.push_back(w);
    a.element = take_element(word);
    if (word.size() > 5 || !numbers(word, a))
      refuse("found " + in_quotes(line) + ", expected serial, name, residue, number, x, y, z, charge, radius");
    a.name = field(12, 4);
    a.residue = field(17 - before, 4);
    a.chain = field(21 - before, 1);
    const std::string_view number = field(22 - before, 5 - before);
    if (!residue_number(number, a))
      refuse("found residue number " + in_quotes(number) + ", expected an integer");
    return a;
  }

  void add(const PqrAtom& a, bool hetero) {
    if (a.radius > believed_radius && !believed_)
      refuse("found radius " + shortest(a.radius) + ", expected one of at most " + shortest(believed_radius) +
             " Å (--format pqr believes it)");
    large_ += a.radius > believed_radius;
    if (std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}) > largest_coordinate)
      refuse("found a coordinate of more than 1e7 Å in magnitude, expected atoms of a molecule");
    if (a.radius > largest_radius)
      refuse("found radius " + shortest(a.radius) + ", expected at most " + shortest(largest_radius) + " Å");
    if (a.radius < 0)
      refuse("found radius " + std::to_string(a.radius) + ", expected a number ≥ 0 (Å)");
    if (!in_model_)
      open_model("");
    pdb::Model& model = parsed_.structure.models.back();
    pdb::Labels& labels = parsed_.structure.labels;
    const auto [found, is_new] = chain_.try_emplace(a.chain, model.chains.size());
    if (is_new)
      model.chains.emplace_back(labels.add(a.chain));
    pdb::Chain& chain = model.chains[found->second];
    const pdb::ResidueId id{gemmi::SeqId(a.number, a.insertion), {}, labels.add(a.residue)};
    if (chain.residues.empty() || !chain.residues.back().matches(id)) {
      chain.residues.emplace_back(id);
      chain.residues.back().het_flag = hetero ? 'H' : 'A';
    }
    pdb::Atom atom;
    atom.name = labels.add(a.name);
    atom.element = a.element == gemmi::El::X ? named_element(a.name, a.residue) : a.element;
    atom.pos = {a.x, a.y, a.z};
    atom.serial = static_cast<int>(parsed_.pqr.size());
    chain.residues.back().atoms.push_back(atom);
    parsed_.pqr.push_back({a.charge, a.radius});
  }

  const std::string& file_;
  Parsed& parsed_;
  const bool believed_;
  PassedOver passed_over_;
  std::set<std::string> glued_; ///< amino acids with a fourth letter
  bool apart_ = false;          ///< is there one without?
  ModelNames names_;
  std::unordered_map<std::string, size_t> chain_; ///< of the model
  int64_t line_ = 0, after_end_ = 0, large_ = 0;
  bool in_model_ = false, ended_ = false;
};

} // namespace

Parsed parse_pqr(std::string_view text, const std::string& file, bool believed) {
  Parsed parsed;
  parsed.format = "PQR";
  PqrLines lines(file, parsed, believed);
  for_each_line(text, [&](std::string_view line, int64_t) { lines.look(line); });
  for_each_line(text, [&](std::string_view line, int64_t number) { lines.take(line, number); });
  lines.finish();
  return parsed;
}

} // namespace molmesh::formats
