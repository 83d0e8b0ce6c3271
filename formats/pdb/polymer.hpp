// polymer.hpp — which hetero residues are links of a chain: modified residues, not ligands.
#pragma once
#include "formats/pdb/structure.hpp"

namespace molmesh::formats {

/// pdb::Residue::flag of hetero residues (HETATM) that belong to a polymer.
inline constexpr char modified_residue = 'm';

/// Marks them. Such a residue stands in the sequence of its chain (mmCIF: its entity is a polymer; PDB: SEQRES
/// names it and the chain's TER comes after it), or it is bonded to backbone atoms of links beside it: on both
/// sides, or on one if it has a backbone or is a usual cap of a chain. Waters are not looked at.
void mark_modified_residues(pdb::Structure& structure, bool is_pdb);

} // namespace molmesh::formats
