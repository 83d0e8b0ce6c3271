// hierarchy.hpp — atoms grouped into residues, chains, domains …, each group with its exponent.
// Equations 2 to 6 of Liao et al. 2013, for any depth.
#pragma once
#include "geom/vec.hpp"
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace molmesh {

struct Atom {
  Vec3d center;        ///< Å, finite
  double radius = 0;   ///< Å, > 0
  double charge = std::numeric_limits<double>::quiet_NaN(); ///< elementary charges; NaN: not given
  std::string name;    ///< "CA"; no white space
  std::string element; ///< "C"
};

/// One group. Its children are groups of the next level, or atoms at the innermost level:
/// [begin, end) indexes level[l + 1].group, or Hierarchy::atom.
struct Group {
  std::string name;
  double exponent = 1; ///< P > 0: F = (Σ children)^P
  int64_t begin = 0, end = 0;
};

struct Level {
  std::string name; ///< "chain"
  std::vector<Group> group;
};

/// Levels outermost first; possibly none (a plain sum over atoms). The groups of level l are consecutive, in file
/// order, and partition level l + 1 (or the atoms) exactly.
struct Hierarchy {
  std::string source; ///< "1tii.pdb sha256:…", empty when unknown
  std::vector<Level> level;
  std::vector<Atom> atom;
};

/// Throws Error(bad_input) naming the first broken rule: ranges that do not partition, values out of range.
void check(const Hierarchy& h, const std::string& file);

} // namespace molmesh
