// resolution.hpp — the exponents P_R, P_C, P_D and the rules that set them for parts of a structure.
// Equations 2 to 6 of Liao et al. 2013: large exponents keep detail, small ones blur. What a selection means is the
// business of the reader that has the structure (formats/pdb).
#pragma once
#include "base/error.hpp"
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace molmesh {

/// No unit, > 0. The defaults enclose the solvent-excluded volume of a protein to about 1 %.
struct Exponents {
  double residue = 0.3, chain = 1, domain = 1; ///< P_R, P_C, P_D
};

/// Sets what is given on every residue, chain and domain that the selection touches.
struct Rule {
  std::string selection;
  std::optional<double> residue, chain, domain;
  std::string where;                ///< for messages: "-r '…'" or "FILE:LINE"
  Status blame = Status::bad_input; ///< what a rule that makes no sense is: usage where it is an option
};

/// One part of a domain; parts of the same name belong together.
struct DomainPart {
  std::string name, selection;
  std::string where;
};

/// "SELECTION P_R=… P_C=… P_D=…", at least one of the three. Throws Error(status) naming `where`.
Rule parse_rule(const std::string& text, const std::string& where, Status status = Status::bad_input);
/// One rule a line; a line that begins with `#` is a comment. Throws Error(bad_input) "FILE:LINE: …".
std::vector<Rule> read_rules(std::istream& in, const std::string& file);
/// Lines `NAME SELECTION`; a line that begins with `#` is a comment. Throws Error(bad_input) "FILE:LINE: …".
std::vector<DomainPart> read_domains(std::istream& in, const std::string& file);

} // namespace molmesh
