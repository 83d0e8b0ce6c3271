// mmjson.hpp — mmJSON (PDBj): the categories of mmCIF as JSON arrays.
#pragma once
#include <gemmi/cifdoc.hpp>
#include <string>
#include <string_view>

namespace molmesh::formats {

class AtomSite;

/// The atoms of the first block that has them go to `atoms`, row by row: gemmi's own reader keeps 16 bytes a value,
/// and runs off its memory on empty columns. Throws Error(bad_input) "FILE:LINE: …".
gemmi::cif::Document read_mmjson(std::string_view text, const std::string& file, AtomSite& atoms);

} // namespace molmesh::formats
