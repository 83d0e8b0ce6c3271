// bcif.hpp — BinaryCIF: the categories of mmCIF as MessagePack, column by column.
#pragma once
#include <gemmi/cifdoc.hpp>
#include <string>

namespace molmesh::formats {

class AtomSite;

/// The categories of entities and assemblies; of others the name alone. The atoms of the first block that has them
/// go to `atoms`, row by row: columns are not unpacked as a whole. A category that is used has at most one row for
/// three bytes and 262,144 more; texts of values are at most most_unpacked(bytes.size()). Throws Error(bad_input)
/// "FILE: …".
gemmi::cif::Document read_bcif(const std::string& bytes, const std::string& file, AtomSite& atoms);

} // namespace molmesh::formats
