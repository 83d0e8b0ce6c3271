// hier_selection.hpp — gemmi's selections (MMDB syntax) on the groups and atoms of a .hier.
#pragma once
#include "molecule/exponents.hpp"
#include "molecule/hierarchy.hpp"

namespace molmesh::formats {

/// [atoms] 1 where "SELECTION" or "around SELECTION Å" selects. Chains and residues are the groups of the levels
/// `chain` and `residue`, residues named NAME:NUMBER as pdb2hier names them; A stands for all of A_1, A_2, … where
/// there is no chain A. Throws Error "WHERE: …": usage for a selection whose syntax is wrong, bad_input for
/// one that asks for a level that the hierarchy does not have, or that touches nothing. absent, if asked for, gets
/// the numbers and ranges of residues that no residue fits, as written, of lists of a hundred at most.
std::vector<uint8_t> select_atoms(const Hierarchy& h, const std::string& selection, const std::string& where,
                                  std::vector<std::string>* absent = nullptr);

/// Applies rules to a hierarchy as it is: on every group of the levels `residue`, `chain` and `domain` of which a
/// rule selects an atom, its exponent is set; later rules win. Throws what select_atoms() throws, and
/// Error(bad_input) for an exponent of a level that the hierarchy does not have.
void apply_rules(Hierarchy& h, const std::vector<Rule>& rules);

} // namespace molmesh::formats
