// exponents.hpp — the exponents P_R, P_C, P_D of residues, chains and domains, and the rules that set them.
// Equation 5 of Liao et al. 2013: P_R = P_R(i_C, i_R). Large exponents keep detail, small ones blur.
#pragma once
#include "base/error.hpp"
#include "molecule/grouping.hpp"
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace molmesh {

/// No unit, > 0. With the defaults, heavy atoms alone enclose the solvent-excluded volume of a protein with room
/// for its hydrogens to about 1 %; molecular_body.hpp has what structures with hydrogens, or with radii of their
/// own, need.
struct Exponents {
  double residue = 0.3, chain = 1, domain = 1; ///< P_R, P_C, P_D
  double weight = 1;                           ///< W_R: residue_weight() makes each residue's weight of it
};

/// Sets the exponents that are given on every residue, chain and domain of which the selection selects an atom, and
/// W_R on its residues: 1 where the rule has P_R alone.
struct Rule {
  std::string selection;
  std::optional<double> residue, chain, domain;
  std::string where;                ///< for messages: "-r '…'" or "FILE:LINE"
  Status blame = Status::bad_input; ///< of an invalid rule: usage if it is an option
  std::optional<double> weight;     ///< W_R
};

/// "SELECTION P_R=… W_R=… P_C=… P_D=…", at least one of the four. Throws Error(status) naming `where`.
Rule parse_rule(const std::string& text, const std::string& where, Status status = Status::bad_input);
/// One rule a line; a line that begins with `#` is a comment. Throws Error(bad_input) "FILE:LINE: …".
std::vector<Rule> read_rules(std::istream& in, const std::string& file);

/// Sets the exponents of all groups, and the weights of residues: the defaults, then rule after rule. Adds a note
/// for each exponent of a level that the hierarchy does not have. Throws Error(bad_input) for a rule that selects
/// nothing or has no effect.
void set_exponents(Grouping& g, const Exponents& defaults, const std::vector<Rule>& rules, const Levels& levels,
                   const StructureSelections& structure, std::vector<std::string>& notes);

} // namespace molmesh
