// bcif.hpp — BinaryCIF: the categories of mmCIF as MessagePack, column by column.
#pragma once
#include <gemmi/cifdoc.hpp>
#include <string>

namespace molmesh::formats {

/// The categories of atoms, entities and assemblies; of others the name alone. Throws Error(bad_input) "FILE: …".
gemmi::cif::Document read_bcif(const std::string& bytes, const std::string& file);

} // namespace molmesh::formats
