// hierarchy.hpp — atoms grouped into residues, chains, domains …, each group with its exponent.
// Equations 2 to 6 of Liao et al. 2013, for any depth.
#pragma once
#include "base/index_table.hpp"
#include "geom/vec.hpp"
#include "molecule/body.hpp"
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh {

/// Atom names and elements, each text stored once: a capsid has 10⁷ atoms and a few dozen names. Entry 0 is "X".
/// Texts stay where they are when more are added or this is moved, unless it is a copy.
class Names {
public:
  Names() { add("X"); }
  /// The entry of `text`, added when new.
  int32_t add(std::string_view text);
  const std::string& operator[](int32_t entry) const;
  int64_t size() const { return size_; }

private:
  static constexpr uint32_t first = 16; ///< texts in the first block; each next one has twice as many
  std::vector<std::vector<std::string>> block_;
  int32_t size_ = 0;
  IndexTable entry_;
};

struct Atom {
  Vec3d center;                                             ///< Å, finite
  double radius = 0;                                        ///< Å, >= 0; 0: a charge without a body
  double charge = std::numeric_limits<double>::quiet_NaN(); ///< elementary charges; NaN: not given
  int32_t name = 0;                                         ///< entry of Hierarchy::names: "CA"
  int32_t element = 0;                                      ///< entry of Hierarchy::names: "C"
};

/// One group. Its children are groups of the next level, or atoms at the innermost level:
/// [begin, end) indexes level[l + 1].group, or Hierarchy::atom.
struct Group {
  std::string name;
  double exponent = 1; ///< P > 0: F = (W Σ children)^P
  int64_t begin = 0, end = 0;
  double weight = 1; ///< W > 0, of the sum
};

struct Level {
  std::string name; ///< "chain"
  std::vector<Group> group;
};

/// Levels outermost first; possibly none (a plain sum over atoms). The groups of level l are consecutive, in file
/// order, and partition level l + 1 (or the atoms) exactly; none is empty.
struct Hierarchy {
  std::string source; ///< "1tii.pdb sha256:…", one line, empty when unknown
  std::vector<Level> level;
  std::vector<Atom> atom;
  std::vector<Body> body; ///< by Body::atom; alone in its innermost group, if there are groups
  Names names;
};

/// Throws Error(bad_input) naming the first broken rule: no atom with a body, ranges that do not partition, an
/// empty group or name, values out of range.
void check(const Hierarchy& h, const std::string& file);

/// Index of the atom whose sphere is nearest to p (inside: negative distance), the first of equals; looks at all
/// that have one.
int64_t nearest_atom(const Hierarchy& h, Vec3d p);
/// "//A/12(GLY)/CA" as a selection; behind the groups of other levels: "domain one //A/12(GLY)/CA".
std::string place_of(const Hierarchy& h, int64_t atom);

/// The same of the atom nearest to p.
std::string nearest_name(const Hierarchy& h, Vec3d p);

} // namespace molmesh
