// operators.cpp — gemmi's transforms of an assembly as rigid motions.
#include "formats/pdb/operators.hpp"
#include "base/error.hpp"
#include "formats/pdb/gunzip.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/read_all.hpp"
#include <algorithm>
#include <istream>

namespace molmesh::formats {
namespace {

bool same(const Rigid& a, const Rigid& b) {
  return a.row[0] == b.row[0] && a.row[1] == b.row[1] && a.row[2] == b.row[2] && a.t == b.t;
}

} // namespace

std::vector<Rigid> read_operators(std::istream& in, const std::string& file, const std::string& assembly) {
  std::string bytes = read_all(in, file);
  if (is_gzip(bytes))
    bytes = gunzip(bytes, file);
  const Parsed parsed = parse_structure(std::move(bytes), file, "auto", assembly);
  const std::vector<gemmi::Assembly>& all = parsed.structure.assemblies;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const gemmi::Assembly& a) { return a.name == assembly; });
  if (found == all.end()) {
    std::string names;
    for (const gemmi::Assembly& a : all)
      names += (names.empty() ? "" : ", ") + a.name;
    fail_input(file + ": found no assembly " + assembly + ", expected " +
               (names.empty() ? "one that the file lists: it lists none" : "one of " + names));
  }
  std::vector<Rigid> motions;
  for (const gemmi::Assembly::Gen& gen : found->generators)
    for (const gemmi::Assembly::Operator& op : gen.operators) {
      Rigid m;
      for (int i = 0; i < 3; ++i)
        m.row[i] = {op.transform.mat[i][0], op.transform.mat[i][1], op.transform.mat[i][2]};
      m.t = {op.transform.vec.x, op.transform.vec.y, op.transform.vec.z};
      if (std::none_of(motions.begin(), motions.end(), [&](const Rigid& other) { return same(m, other); }))
        motions.push_back(m);
    }
  return motions;
}

} // namespace molmesh::formats
