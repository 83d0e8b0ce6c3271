// pdb_text.hpp — structures as short texts, and their hierarchies.
#pragma once
#include "base/error.hpp"
#include "formats/hier/hier.hpp"
#include "formats/pdb/pdb.hpp"
#include "unit/refusal.hpp"
#include <cstdio>
#include <fstream>
#include <sstream>

namespace molmesh::test {

struct Converted {
  Hierarchy hierarchy;
  formats::PdbReport report;
  std::string text;
};

inline Converted convert(const std::string& bytes, const formats::PdbOptions& options = {},
                         const std::string& name = "x.pdb") {
  std::istringstream in(bytes);
  const formats::PdbHierarchy pdb(in, name, options);
  std::ostringstream out;
  pdb.write(out);
  std::istringstream back(out.str());
  return {formats::read_hier(back, "back.hier"), pdb.report(), out.str()};
}

/// The message of the error; empty when there is none.
inline std::string refusal(const std::string& bytes, const formats::PdbOptions& options = {},
                           const std::string& name = "x.pdb", Status status = Status::bad_input) {
  return refusal(status, [&] { convert(bytes, options, name); });
}

/// One line of the PDB format.
inline std::string pdb_atom(const std::string& name, const std::string& residue, const std::string& chain,
                            int number, double x, const std::string& element, char altloc = ' ',
                            double occupancy = 1, char insertion = ' ', const char* record = "ATOM  ") {
  char line[200];
  std::snprintf(line, sizeof line, "%-6s%5d %-4s%c%3s%2s%4d%c   %8.3f%8.3f%8.3f%6.2f%6.2f          %2s\n", record,
                1, name.c_str(), altloc, residue.c_str(), chain.c_str(), number, insertion, x, 0.0, 0.0, occupancy,
                10.0, element.c_str());
  return line;
}

/// "A/GLY:1/CA B/…": chain, residue and atom of every atom, for structures with these two levels.
inline std::string listing(const Hierarchy& h) {
  std::string s;
  for (const Group& chain : h.level.at(0).group)
    for (int64_t r = chain.begin; r < chain.end; ++r) {
      const Group& residue = h.level.at(1).group[r];
      for (int64_t a = residue.begin; a < residue.end; ++a)
        s += (s.empty() ? "" : " ") + chain.name + "/" + residue.name + "/" + h.names[h.atom[a].name];
    }
  return s;
}

inline std::string slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

} // namespace molmesh::test
