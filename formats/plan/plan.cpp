// plan.cpp — words of a line to the motions of its copies.
#include "formats/plan/plan.hpp"
#include "base/error.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace molmesh::formats {
namespace {

constexpr double rotation_rounding = 1e-3; // files have few decimals
constexpr double most_copies = 100'000;

/// Words between blanks; double quotes hold blanks.
std::vector<std::string> quoted_words(std::string_view line, const std::string& where) {
  std::vector<std::string> all;
  bool open = false, quoted = false;
  for (const char c : line) {
    if (!quoted && (c == ' ' || c == '\t')) {
      open = false;
      continue;
    }
    if (!open)
      all.emplace_back();
    open = true;
    if (c == '"')
      quoted = !quoted;
    else
      all.back() += c;
  }
  if (quoted)
    fail_input(where + ": P1: found a quote that does not end, expected another");
  return all;
}

/// KEY=VALUE.
struct Key {
  const std::string& where;
  std::string name, value;

  [[noreturn]] void refuse(const char* rule, const std::string& expected) const {
    fail_input(where + ": " + rule + ": found '" + name + "=" + value + "', expected " + expected);
  }
  std::vector<double> numbers(std::initializer_list<size_t> counts, const std::string& expected) const {
    std::vector<double> all;
    for (size_t begin = 0;;) {
      const size_t comma = std::min(value.find(',', begin), value.size());
      const std::optional<double> v = signed_decimal(std::string_view(value).substr(begin, comma - begin));
      if (!v || !(std::abs(*v) < 1e9))
        refuse("P3", expected);
      all.push_back(*v);
      if (comma == value.size())
        break;
      begin = comma + 1;
    }
    if (std::find(counts.begin(), counts.end(), all.size()) == counts.end())
      refuse("P3", expected);
    return all;
  }
  int count(double v, const std::string& expected) const {
    if (!(v >= 1 && v <= most_copies && v == std::floor(v)))
      refuse("P5", expected);
    return static_cast<int>(v);
  }
};

Vec3d at(const std::vector<double>& v, size_t i) {
  return {v[i], v[i + 1], v[i + 2]};
}

/// The motions that a key asks for, one for each copy; none: the key is no motion.
std::vector<Rigid> motions(const Key& key) {
  if (key.name == "translate")
    return {translation(at(key.numbers({3}, "X,Y,Z (Å)"), 0))};
  if (key.name == "rotate") {
    const char* const expected = "X,Y,Z,DEGREES or X,Y,Z,DEGREES,PX,PY,PZ, an axis that is not 0 and a point on it";
    const std::vector<double> v = key.numbers({4, 7}, expected);
    if (!(norm(at(v, 0)) > 0))
      key.refuse("P4", expected);
    return {rotation(at(v, 0), v[3], v.size() == 7 ? at(v, 4) : Vec3d{})};
  }
  if (key.name == "matrix") {
    const std::vector<double> v =
        key.numbers({9, 12}, "9 numbers, or 12 of which every fourth is a shift (Å): the rows of a rotation");
    Rigid m = rigid_of_rows(v);
    if (!is_rotation(m, rotation_rounding))
      key.refuse("P4", "a rotation, which neither scales nor shears nor mirrors");
    m.row[0] = m.row[0] / norm(m.row[0]); // to the last bit
    m.row[2] = cross(m.row[0], m.row[1]) / norm(cross(m.row[0], m.row[1]));
    m.row[1] = cross(m.row[2], m.row[0]);
    return {m};
  }
  std::vector<Rigid> steps;
  if (key.name == "helix") {
    const char* const expected = "N,RISE,DEGREES, or with an axis N,RISE,DEGREES,X,Y,Z, or with a point on it "
                                 "N,RISE,DEGREES,X,Y,Z,PX,PY,PZ; N from 1 to 100000";
    const std::vector<double> v = key.numbers({3, 6, 9}, expected);
    if (v.size() > 3 && !(norm(at(v, 3)) > 0))
      key.refuse("P4", expected);
    const Vec3d axis = v.size() > 3 ? at(v, 3) / norm(at(v, 3)) : Vec3d{0, 0, 1};
    for (int k = 0; k < key.count(v[0], expected); ++k)
      steps.push_back(translation(k * v[1] * axis) * rotation(axis, k * v[2], v.size() > 6 ? at(v, 6) : Vec3d{}));
  } else if (key.name == "lattice") {
    const char* const expected =
        "NX,NY,NZ,DX,DY,DZ (steps along the axes, Å) or NX,NY,NZ and three vectors; NX, NY, "
        "NZ from 1, 100000 at most";
    const std::vector<double> v = key.numbers({6, 12}, expected);
    const bool skew = v.size() == 12;
    const Vec3d a = skew ? at(v, 3) : Vec3d{v[3], 0, 0}, b = skew ? at(v, 6) : Vec3d{0, v[4], 0},
                c = skew ? at(v, 9) : Vec3d{0, 0, v[5]};
    const int nx = key.count(v[0], expected), ny = key.count(v[1], expected), nz = key.count(v[2], expected);
    if (double{1} * nx * ny * nz > most_copies)
      key.refuse("P5", expected);
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < nz; ++k)
          steps.push_back(translation(double(i) * a + double(j) * b + double(k) * c));
  }
  return steps;
}

PlanPiece piece_of(const std::vector<std::string>& word, size_t first, const std::string& where) {
  PlanPiece p;
  p.where = where;
  if (word.size() <= first || word[first].empty())
    fail_input(where + ": P1: found no file, expected FILE KEY=VALUE …");
  p.file = word[first];
  for (size_t i = first + 1; i < word.size(); ++i) {
    const size_t equals = word[i].find('=');
    if (equals == std::string::npos || equals == 0)
      fail_input(where + ": P2: found '" + word[i] + "', expected KEY=VALUE");
    const Key key{where, word[i].substr(0, equals), word[i].substr(equals + 1)};
    if (key.name == "combine") {
      if (key.value != "subtract")
        key.refuse("P2", "subtract");
      p.subtract = true;
      continue;
    }
    const std::vector<Rigid> steps = motions(key);
    if (steps.empty())
      key.refuse("P2", "one of translate, rotate, matrix, helix, lattice, combine");
    if (double(steps.size()) * double(p.copies.size()) > most_copies)
      key.refuse("P5", "at most 100000 copies");
    std::vector<Rigid> moved;
    for (const Rigid& step : steps)
      for (const Rigid& copy : p.copies)
        moved.push_back(copy.is_identity() ? step : step * copy);
    p.copies = std::move(moved);
  }
  return p;
}

} // namespace

PlanPiece parse_piece(std::string_view text, const std::string& where) {
  return piece_of(quoted_words(text, where), 0, where);
}

std::vector<PlanPiece> read_plan(std::istream& in, const std::string& file) {
  const size_t slash = file.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : file.substr(0, slash + 1);
  std::vector<PlanPiece> plan;
  double copies = 0;
  bool begun = false;
  read_lines(in, file, [&](const std::string& line, const std::string& where) {
    const std::vector<std::string> word = quoted_words(line, where);
    if (!begun) {
      if (word.size() != 2 || word[0] != "join" || word[1] != "1")
        fail_input(where + ": P1: found '" + line.substr(0, 40) + "', expected join 1");
      begun = true;
      return;
    }
    if (word[0] != "piece")
      fail_input(where + ": P2: found '" + word[0].substr(0, 40) + "', expected piece");
    plan.push_back(piece_of(word, 1, where));
    if (plan.back().file[0] != '/')
      plan.back().file = folder + plan.back().file;
    copies += static_cast<double>(plan.back().copies.size());
    if (copies > most_copies)
      fail_input(where + ": P5: found more than 100000 copies in all, expected fewer");
  });
  if (plan.empty())
    fail_input(file + ": P1: found no piece, expected join 1 and a line piece FILE KEY=VALUE … for each");
  return plan;
}

} // namespace molmesh::formats
