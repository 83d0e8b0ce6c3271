// join.cpp — .join line by line: words, keys, motions and copies.
#include "formats/join/join.hpp"
#include "formats/join/body_keys.hpp"
#include "formats/join/key_value.hpp"
#include "molecule/limits.hpp"
#include <algorithm>
#include <istream>

namespace molmesh::formats {
namespace {

constexpr double rotation_rounding = 0.01; // files of old entries have few decimals

/// Words between blanks; double quotes hold blanks.
std::vector<std::string> quoted_words(const std::string& line, const std::string& where) {
  std::vector<std::string> all;
  bool open = false, quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
      if (!open)
        all.emplace_back();
      open = true;
    } else if (!quoted && (c == ' ' || c == '\t')) {
      open = false;
    } else {
      if (!open)
        all.emplace_back();
      open = true;
      all.back() += c;
    }
  }
  if (quoted)
    fail_input(where + ": found a quote that does not end, expected another");
  return all;
}

/// What a key does to the copies so far; false: it is none of these.
bool motions(const std::string& key, const KeyValue& line, const AssemblyReader& assembly, const std::string& where,
             std::vector<Rigid>& copies) {
  std::vector<Rigid> steps;
  if (key == "translate") {
    const char* const expected = "X,Y,Z (Å)";
    const std::vector<double> v = line.numbers(expected);
    if (v.size() != 3)
      line.refuse(expected);
    steps = {translation(at(v, 0))};
  } else if (key == "rotate") {
    const char* const expected = "X,Y,Z,DEGREES or X,Y,Z,DEGREES,PX,PY,PZ, an axis that is not 0 and a point on it";
    const std::vector<double> v = line.numbers(expected);
    if ((v.size() != 4 && v.size() != 7) || !(norm(at(v, 0)) > 0))
      line.refuse(expected);
    steps = {rotation(at(v, 0), v[3], v.size() == 7 ? at(v, 4) : Vec3d{})};
  } else if (key == "matrix") {
    const char* const expected = "9 numbers, or 12 of which every fourth is a shift (Å): the rows of a rotation";
    const std::vector<double> v = line.numbers(expected);
    if (v.size() != 9 && v.size() != 12)
      line.refuse(expected);
    const Rigid m = rigid_of_rows(v);
    if (!is_rotation(m, rotation_rounding))
      line.refuse("a rotation, which neither scales nor shears nor mirrors");
    steps = {m};
  } else if (key == "helix") {
    const char* const expected = "N,RISE,DEGREES, or with an axis N,RISE,DEGREES,X,Y,Z, or with a point on it "
                                 "N,RISE,DEGREES,X,Y,Z,PX,PY,PZ; "
                                 "N from 1 to 100000";
    const std::vector<double> v = line.numbers(expected);
    if ((v.size() != 3 && v.size() != 6 && v.size() != 9) || (v.size() > 3 && !(norm(at(v, 3)) > 0)))
      line.refuse(expected);
    const Vec3d axis = v.size() > 3 ? at(v, 3) / norm(at(v, 3)) : Vec3d{0, 0, 1};
    const int n = line.count(v[0], expected);
    for (int k = 0; k < n; ++k)
      steps.push_back(translation(k * v[1] * axis) * rotation(axis, k * v[2], v.size() > 6 ? at(v, 6) : Vec3d{}));
  } else if (key == "lattice") {
    const char* const expected = "NX,NY,NZ,DX,DY,DZ (steps along the axes, Å) or NX,NY,NZ and three vectors; NX, "
                                 "NY, NZ from 1, 100000 at most";
    const std::vector<double> v = line.numbers(expected);
    if (v.size() != 6 && v.size() != 12)
      line.refuse(expected);
    const bool skew = v.size() == 12;
    const Vec3d a = skew ? at(v, 3) : Vec3d{v[3], 0, 0}, b = skew ? at(v, 6) : Vec3d{0, v[4], 0},
                c = skew ? at(v, 9) : Vec3d{0, 0, v[5]};
    const int nx = line.count(v[0], expected), ny = line.count(v[1], expected), nz = line.count(v[2], expected);
    if (double{1} * nx * ny * nz > double{most_copies})
      line.refuse(expected);
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < nz; ++k)
          steps.push_back(translation(double(i) * a + double(j) * b + double(k) * c));
  } else if (key == "assembly") {
    const char* const expected = "FILE:ID, an assembly of a structure file";
    const std::string value = line.text(expected);
    const size_t colon = value.rfind(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == value.size())
      line.refuse(expected);
    steps = assembly(value.substr(0, colon), value.substr(colon + 1), where);
    for (const Rigid& m : steps)
      if (!is_rotation(m, rotation_rounding))
        line.refuse("operators that neither scale nor shear nor mirror");
  } else {
    return false;
  }
  if (steps.size() * copies.size() > most_copies)
    line.refuse("at most 100000 copies");
  std::vector<Rigid> moved;
  for (const Rigid& step : steps)
    for (const Rigid& copy : copies)
      moved.push_back(copy.is_identity() ? step : step * copy);
  copies = std::move(moved);
  return true;
}

std::map<std::string, std::string> renames(const KeyValue& line) {
  const char* const expected = "OLD:NEW,OLD:NEW,…, each old and each new name once";
  std::map<std::string, std::string> names;
  std::vector<std::string> fresh;
  for (const std::string& pair : line.list()) {
    const size_t colon = pair.find(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == pair.size() ||
        pair.find(':', colon + 1) != std::string::npos)
      line.refuse(expected);
    fresh.push_back(pair.substr(colon + 1));
    if (!names.try_emplace(pair.substr(0, colon), fresh.back()).second)
      line.refuse(expected);
  }
  std::sort(fresh.begin(), fresh.end());
  if (std::adjacent_find(fresh.begin(), fresh.end()) != fresh.end())
    line.refuse(expected);
  return names;
}

/// The keys from the `first` word on. body: null for a piece.
Piece read_piece(const std::vector<std::string>& word, size_t first, const std::string& where,
                 const AssemblyReader& assembly, BodyKeys* body) {
  Piece p;
  p.where = where;
  std::vector<std::string> seen;
  for (size_t i = first; i < word.size(); ++i) {
    const size_t equals = word[i].find('=');
    if (equals == std::string::npos || equals == 0)
      fail_input(where + ": found '" + word[i] + "', expected KEY=VALUE");
    const std::string key = word[i].substr(0, equals), value = word[i].substr(equals + 1);
    const KeyValue line(where, key, value);
    if (motions(key, line, assembly, where, p.copies))
      continue;
    if (std::find(seen.begin(), seen.end(), key) != seen.end())
      line.refuse("each key once, but for motions and copies");
    seen.push_back(key);
    if (body != nullptr && body->take(key, line))
      continue;
    if (key == "domain")
      p.domain = line.text("a name");
    else if (key == "chain" && body != nullptr)
      p.rename = {{word[1], line.text("a name")}};
    else if (key == "chains" && body == nullptr)
      p.rename = renames(line);
    else if (key == "prefix")
      p.prefix = line.text("what comes before names");
    else if (key == "suffix")
      p.suffix = line.text("what comes after names");
    else if (key == "carve" && body == nullptr)
      p.carve = line.number(0, largest_radius, "a distance > 0 and at most 10000 Å");
    else if (key == "P_R")
      p.residue = line.number(0, largest_exponent, "an exponent > 0 and at most 1000");
    else if (key == "P_C")
      p.chain = line.number(0, largest_exponent, "an exponent > 0 and at most 1000");
    else if (key == "P_D")
      p.domain_exponent = line.number(0, largest_exponent, "an exponent > 0 and at most 1000");
    else
      line.refuse(body == nullptr
                      ? "one of translate, rotate, matrix, helix, lattice, assembly, domain, chains, "
                        "prefix, suffix, carve, P_R, P_C, P_D"
                      : "a key of this shape, skin, or one of translate, rotate, matrix, helix, lattice, "
                        "assembly, domain, chain, prefix, suffix, P_R, P_C, P_D");
  }
  return p;
}

} // namespace

JoinPlan read_join(std::istream& in, const std::string& file, const AssemblyReader& assembly) {
  JoinPlan plan;
  bool begun = false;
  read_lines(in, file, [&](const std::string& line, const std::string& where) {
    const std::vector<std::string> word = quoted_words(line, where);
    if (!begun) {
      if (word.size() != 2 || word[0] != "join" || word[1] != "1")
        fail_input(where + ": found '" + line + "', expected 'join 1'");
      begun = true;
    } else if (word[0] == "piece") {
      if (word.size() < 2 || word[1].empty())
        fail_input(where + ": the line ends, expected 'piece FILE KEY=VALUE …'");
      plan.piece.push_back(read_piece(word, 2, where, assembly, nullptr));
      plan.file.push_back(word[1]);
      plan.body.emplace_back();
    } else if (word[0] == "body") {
      const std::optional<Body::Shape> shape = word.size() < 3 ? std::nullopt : shape_of(word[2]);
      if (!shape || word[1].empty())
        fail_input(where + ": found '" + line +
                   "', expected 'body NAME SHAPE KEY=VALUE …', SHAPE sphere, capsule, cylinder, box or slab");
      BodyKeys keys(*shape);
      plan.piece.push_back(read_piece(word, 3, where, assembly, &keys));
      plan.file.push_back(word[1]);
      plan.body.emplace_back(keys.body(where));
    } else if (word[0] == "rule") {
      plan.rule.push_back(parse_rule(line.substr(4), where));
    } else {
      fail_input(where + ": found '" + word[0] + "', expected piece, body or rule");
    }
  });
  if (!begun)
    fail_input(file + ":1: the file is empty, expected 'join 1'");
  if (plan.piece.empty())
    fail_input(file + ": found no piece, expected at least one");
  return plan;
}

} // namespace molmesh::formats
