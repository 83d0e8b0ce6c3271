// chains.hpp — the parts of chains joined. gemmi searches all chains from the start for each; here it is looked up.
#pragma once
#include "formats/pdb/structure.hpp"

namespace molmesh::formats {

/// As gemmi::Structure::merge_chain_parts().
void merge_chain_parts(pdb::Structure& structure);

} // namespace molmesh::formats
