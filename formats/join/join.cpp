// join.cpp — .join line by line: pieces, bodies, rules, and their keys.
#include "formats/join/join.hpp"
#include "formats/join/body_keys.hpp"
#include "formats/plan/motions.hpp"
#include "molecule/limits.hpp"
#include <algorithm>
#include <cmath>
#include <istream>

namespace molmesh::formats {
namespace {

constexpr MotionRules rules; // rotations of old entries have few decimals

/// What a key does to the copies so far; false: it is none of these.
bool move(const std::string& key, const KeyValue& line, const AssemblyReader& assembly, const std::string& where,
          std::vector<Rigid>& copies) {
  std::vector<Rigid> steps = motions(key, line, rules);
  if (key == "assembly") {
    const char* const expected = "FILE:ID, an assembly of a structure file";
    const std::string value = line.text(expected);
    const size_t colon = value.rfind(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == value.size())
      line.refuse(expected);
    steps = assembly(value.substr(0, colon), value.substr(colon + 1), where);
    for (const Rigid& m : steps)
      if (!is_rotation(m, rules.rounding))
        line.refuse("operators that neither scale nor shear nor mirror");
  } else if (steps.empty()) {
    return false;
  }
  repeat(copies, steps, line);
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
    if (move(key, line, assembly, where, p.copies))
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
      p.residue =
          line.number(std::nextafter(least_exponent, 0.), largest_exponent, "an exponent from 0.0001 to 1000");
    else if (key == "P_C")
      p.chain =
          line.number(std::nextafter(least_exponent, 0.), largest_exponent, "an exponent from 0.0001 to 1000");
    else if (key == "P_D")
      p.domain_exponent =
          line.number(std::nextafter(least_exponent, 0.), largest_exponent, "an exponent from 0.0001 to 1000");
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
