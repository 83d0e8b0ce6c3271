// join.hpp — several hierarchies into one, at the level of atoms: placed, renamed, carved, in domains.
#pragma once
#include "geom/rigid.hpp"
#include "molecule/hierarchy.hpp"
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace molmesh {

/// A hierarchy and where its copies go.
struct Piece {
  std::shared_ptr<const Hierarchy> hierarchy;
  std::string where;                         ///< for messages: "FILE:LINE"
  std::vector<Rigid> copies = {Rigid{}};     ///< at least one
  std::string domain;                        ///< that holds all of it; empty: its own
  std::map<std::string, std::string> rename; ///< old name to new, of the level below the domains
  std::string prefix, suffix;                ///< of these names
  /// P of its groups, where not as they are; residues whose P is set have the weight 1.
  std::optional<double> residue, chain, domain_exponent;
  double carve = 0; ///< Å: its residues within this distance (between centers) of pieces before it are left out
};

/// The names of a hierarchy's levels without an outermost `domain`.
std::vector<std::string> levels_below_domains(const Hierarchy& h);
/// One body in groups of its name, exponents 1. levels: outermost first; without any, it is alone.
Hierarchy hierarchy_of(const Body& body, const std::string& name, const std::vector<std::string>& levels);

/// Of one piece.
struct Joined {
  int64_t copies = 0, atoms = 0;
  std::map<std::string, int64_t> carved; ///< residues left out, by name without number
};

/// What happens to two groups of one name: refused, or numbered NAME_1, NAME_2, ….
enum class Clash { refuse, number };

/// The levels are those of the pieces, equal but for an outermost `domain`, which all have or none has after
/// Piece::domain. Domains stand in the order in which pieces first name them; pieces of one domain's name are one
/// group, unless the names are their own. Groups of the level below (chains) get unique names: of several copies,
/// NAME_1, NAME_2, …. Atoms are moved in double precision, and nothing is rounded. `source` stays empty. Throws
/// Error(bad_input) "WHERE: …" for levels that do not fit, names that clash, a name to be replaced that is not
/// there, and pieces of which nothing is left.
Hierarchy join(const std::vector<Piece>& pieces, Clash clash, std::vector<Joined>& joined);

} // namespace molmesh
