// hier_selection.hpp — gemmi's selections (MMDB syntax) on the groups and atoms of a .hier.
#pragma once
#include "molecule/hierarchy.hpp"

namespace molmesh::formats {

/// [atoms] 1 where "SELECTION" or "around SELECTION Å" selects. Chains and residues are the groups of the levels
/// `chain` and `residue`, residues named NAME:NUMBER as pdb2hier names them; A stands for all of A_1, A_2, … where
/// there is no chain A. Throws Error "WHERE: …": usage for a selection whose syntax is wrong, bad_input for
/// one that asks for a level that the hierarchy does not have, or that touches nothing.
std::vector<uint8_t> select_atoms(const Hierarchy& h, const std::string& selection, const std::string& where);

} // namespace molmesh::formats
