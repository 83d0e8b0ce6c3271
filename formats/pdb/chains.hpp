// chains.hpp — very many residues in a chain, and very many chains, as boxes of water have them: gemmi searches
// them from the start for every residue of mmCIF and for every chain. Here each is looked up.
#pragma once
#include <gemmi/model.hpp>

namespace gemmi::cif {
struct Loop;
}

namespace molmesh::formats {

class AtomColumns;

/// Before gemmi reads the table: further runs of chains of many residues get names of their own. False: there
/// is none.
bool divide_long_chains(gemmi::cif::Loop& loop, AtomColumns& columns);
/// Afterwards, where there was: they are one chain again, as gemmi would have read it undivided.
void join_divided_chains(gemmi::Structure& structure);

/// As gemmi::Structure::merge_chain_parts().
void merge_chain_parts(gemmi::Structure& structure);

} // namespace molmesh::formats
