// motions.cpp — words of a line to the motions of its copies.
#include "formats/plan/motions.hpp"

namespace molmesh::formats {

std::vector<std::string> quoted_words(std::string_view line, const std::string& where, const char* rule) {
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
    fail_input(where + ": " + rule + "found a quote that does not end, expected another");
  return all;
}

std::vector<Rigid> motions(const std::string& key, const KeyValue& line, const MotionRules& rules) {
  const auto numbers = [&](std::initializer_list<size_t> counts, const char* expected) {
    return line.numbers(counts, expected, rules.form, rules.bound);
  };
  if (key == "translate")
    return {translation(at(numbers({3}, "X,Y,Z (Å)"), 0))};
  if (key == "rotate") {
    const char* const expected = "X,Y,Z,DEGREES or X,Y,Z,DEGREES,PX,PY,PZ, an axis that is not 0 and a point on it";
    const std::vector<double> v = numbers({4, 7}, expected);
    if (!(norm(at(v, 0)) > 0))
      line.refuse(expected, rules.value);
    return {rotation(at(v, 0), v[3], v.size() == 7 ? at(v, 4) : Vec3d{})};
  }
  if (key == "matrix") {
    const std::vector<double> v =
        numbers({9, 12}, "9 numbers, or 12 of which every fourth is a shift (Å): the rows of a rotation");
    Rigid m = rigid_of_rows(v);
    if (!is_rotation(m, rules.rounding))
      line.refuse("a rotation, which neither scales nor shears nor mirrors", rules.value);
    if (rules.orthonormal) {
      m.row[0] = m.row[0] / norm(m.row[0]);
      m.row[2] = cross(m.row[0], m.row[1]) / norm(cross(m.row[0], m.row[1]));
      m.row[1] = cross(m.row[2], m.row[0]);
    }
    return {m};
  }
  std::vector<Rigid> steps;
  if (key == "helix") {
    const char* const expected = "N,RISE,DEGREES, or with an axis N,RISE,DEGREES,X,Y,Z, or with a point on it "
                                 "N,RISE,DEGREES,X,Y,Z,PX,PY,PZ; N from 1 to 100000";
    const std::vector<double> v = numbers({3, 6, 9}, expected);
    if (v.size() > 3 && !(norm(at(v, 3)) > 0))
      line.refuse(expected, rules.value);
    const Vec3d axis = v.size() > 3 ? at(v, 3) / norm(at(v, 3)) : Vec3d{0, 0, 1};
    const int n = line.count(v[0], expected, rules.count);
    for (int k = 0; k < n; ++k)
      steps.push_back(translation(k * v[1] * axis) * rotation(axis, k * v[2], v.size() > 6 ? at(v, 6) : Vec3d{}));
  } else if (key == "lattice") {
    const char* const expected =
        "NX,NY,NZ,DX,DY,DZ (steps along the axes, Å) or NX,NY,NZ and three vectors; NX, NY, "
        "NZ from 1, 100000 at most";
    const std::vector<double> v = numbers({6, 12}, expected);
    const bool skew = v.size() == 12;
    const Vec3d a = skew ? at(v, 3) : Vec3d{v[3], 0, 0}, b = skew ? at(v, 6) : Vec3d{0, v[4], 0},
                c = skew ? at(v, 9) : Vec3d{0, 0, v[5]};
    const int nx = line.count(v[0], expected, rules.count), ny = line.count(v[1], expected, rules.count),
              nz = line.count(v[2], expected, rules.count);
    if (double{1} * nx * ny * nz > double{most_copies})
      line.refuse(expected, rules.count);
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < nz; ++k)
          steps.push_back(translation(double(i) * a + double(j) * b + double(k) * c));
  }
  return steps;
}

void repeat(std::vector<Rigid>& copies, const std::vector<Rigid>& steps, const KeyValue& line, const char* rule) {
  if (steps.size() * copies.size() > most_copies)
    line.refuse("at most 100000 copies", rule);
  std::vector<Rigid> moved;
  for (const Rigid& step : steps)
    for (const Rigid& copy : copies)
      moved.push_back(copy.is_identity() ? step : step * copy);
  copies = std::move(moved);
}

} // namespace molmesh::formats
