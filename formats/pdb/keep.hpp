// keep.hpp — which models, conformers, waters, hydrogens and hetero atoms stay.
#pragma once
#include "formats/pdb/parse.hpp"
#include "formats/pdb/pdb.hpp"

namespace molmesh::formats {

/// Removes from the structure what the options drop, and counts it. Blank chain names become "_". Throws
/// Error(bad_input) when nothing remains or the model is not there.
void keep(Parsed& parsed, const std::string& file, const PdbOptions& options, PdbReport& report);

/// By its name in the PDB or in the files of molecular dynamics.
bool is_water(const pdb::Residue& residue);
/// "ANS:373", as in a .hier.
inline std::string name_in_hierarchy(const pdb::Residue& residue) {
  return residue.name.str() + ':' + residue.seqid.str();
}

} // namespace molmesh::formats
