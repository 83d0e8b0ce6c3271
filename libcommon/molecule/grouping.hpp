// grouping.hpp — which chain and which domain each residue of a structure belongs to.
// Equations 2 and 3 of Liao et al. 2013: the residues of a chain, and the chains or residues of a domain, are
// disjoint, and together they are all.
#pragma once
#include "base/error.hpp"
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace molmesh {

/// The residues of a structure, copies included, with their groups and the exponents of all groups (equation 5).
struct Grouping {
  struct Residue {
    int32_t chain;      ///< index into `chain`
    int32_t domain = 0; ///< index into `domain`
    int32_t bodies = 1; ///< atoms of a radius > 0
  };
  std::vector<Residue> residue;    ///< in the order of the file, copy after copy
  std::vector<std::string> chain;  ///< unique names
  std::vector<std::string> domain; ///< unique names; empty without domains
  std::vector<double> residue_exponent, chain_exponent, domain_exponent; ///< P_R, P_C, P_D, one a group
  std::vector<double> residue_weight;                                    ///< W_R
};

/// How many atoms of a residue a selection selects.
enum class Selected : uint8_t { none, some, all };

/// Answers what selections select. The reader of a format implements it: it has the structure.
class StructureSelections {
public:
  virtual ~StructureSelections() = default;
  /// One answer for each residue of the grouping. may_be_around: "around SELECTION Å" is allowed, too. Throws
  /// Error(status) "WHERE: …" if the syntax is wrong.
  virtual std::vector<Selected> select(const std::string& selection, const std::string& where, bool may_be_around,
                                       Status status) const = 0;
  /// The first atom of a residue, "//A/12(GLY)/CA".
  virtual std::string first_atom(int64_t residue) const = 0;
  /// The first atom of a residue outside the selection, which selects some of the residue's atoms.
  virtual std::string first_atom_outside(int64_t residue, const std::string& selection,
                                         const std::string& where) const = 0;
};

/// Levels of a hierarchy: "domain", "chain", "residue", outermost first.
using Levels = std::vector<std::string>;
bool has_level(const Levels& levels, const std::string& level);
/// Throws Error(usage) for other names, a level given twice, one within residues, or domains without a definition
/// and the other way round.
void check_levels(const Levels& levels, bool domains_are_defined);

/// One part of a domain: the residues of a selection. Parts with the same name form one domain.
struct DomainPart {
  std::string name, selection;
  std::string where; ///< for messages: "FILE:LINE"
};
/// Reads lines `NAME SELECTION`; a line that begins with `#` is a comment. Throws Error(bad_input) "FILE:LINE: …".
std::vector<DomainPart> read_domains(std::istream& in, const std::string& file);

/// Sets the domains from parts. Throws Error(bad_input) if a residue lies in no domain, in two, or partly in one,
/// naming an atom of it, or if a part selects nothing.
void set_domains(Grouping& g, const std::vector<DomainPart>& parts, const StructureSelections& structure);
/// Sets the domains from a domain's name for each chain.
void set_domains(Grouping& g, const std::vector<std::string>& domain_of_chain);
/// Throws Error(bad_input) if domains hold chains, by the levels, and a chain lies in two domains.
void check_domains(const Grouping& g, const Levels& levels, const std::string& file,
                   const StructureSelections& structure);

/// Returns the indices of the residues in an order in which the groups of all levels are contiguous, and otherwise
/// that of the file.
std::vector<int32_t> hierarchy_order(const Grouping& g, const Levels& levels);

/// A name as a selection wants it: in double quotes if it has a character that means something there.
std::string in_selection(const std::string& name);

/// "ASP:102" of chain A as "//A/102(ASP)"; chain may be empty: any.
std::string residue_in_selection(const std::string& chain, const std::string& residue);

/// For a message about a selection that finds nothing: "; chains here: A, B, C (for example '//A', '//A/45-60')".
/// Distinct names, at most twenty; empty where there are none.
std::string chains_there(const std::vector<std::string>& names);

} // namespace molmesh
