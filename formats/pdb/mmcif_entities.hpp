// mmcif_entities.hpp — what mmCIF says of entities: kinds, sequences, subchains.
#pragma once
#include "formats/pdb/structure.hpp"

namespace gemmi::cif {
struct Block;
}

namespace molmesh::formats {

/// Reads _entity, _entity_poly, _entity_poly_seq and _struct_asym as gemmi::make_structure_from_block() does, but
/// in a time that grows with their rows. Then names the subchains of entities where the file does not, and sets the
/// kinds of the residues.
void read_entities(gemmi::cif::Block& block, pdb::Structure& structure);

} // namespace molmesh::formats
