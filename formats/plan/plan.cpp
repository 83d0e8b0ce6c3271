// plan.cpp — lines of a plan to pieces and their places.
#include "formats/plan/plan.hpp"
#include "formats/plan/motions.hpp"
#include <istream>

namespace molmesh::formats {
namespace {

constexpr MotionRules rules{"P3: ", "P4: ", "P5: ", 1e9, 1e-3, true}; // 1e-3: files have few decimals

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
    const std::string key = word[i].substr(0, equals), value = word[i].substr(equals + 1);
    const KeyValue line(where, key, value);
    if (key == "combine") {
      if (value != "subtract")
        line.refuse("subtract", "P2: ");
      p.subtract = true;
      continue;
    }
    const std::vector<Rigid> steps = motions(key, line, rules);
    if (steps.empty())
      line.refuse("one of translate, rotate, matrix, helix, lattice, combine", "P2: ");
    repeat(p.copies, steps, line, rules.count);
  }
  return p;
}

} // namespace

PlanPiece parse_piece(std::string_view text, const std::string& where) {
  return piece_of(quoted_words(text, where, "P1: "), 0, where);
}

std::vector<PlanPiece> read_plan(std::istream& in, const std::string& file) {
  const size_t slash = file.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : file.substr(0, slash + 1);
  std::vector<PlanPiece> plan;
  size_t copies = 0;
  bool begun = false;
  read_lines(in, file, [&](const std::string& line, const std::string& where) {
    const std::vector<std::string> word = quoted_words(line, where, "P1: ");
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
    copies += plan.back().copies.size();
    if (copies > most_copies)
      fail_input(where + ": P5: found more than 100000 copies in all, expected fewer");
  });
  if (plan.empty())
    fail_input(file + ": P1: found no piece, expected join 1 and a line piece FILE KEY=VALUE … for each");
  return plan;
}

} // namespace molmesh::formats
