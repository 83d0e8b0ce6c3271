// mmjson.hpp — mmJSON (PDBj): the categories of mmCIF as JSON arrays.
#pragma once
#include <gemmi/cifdoc.hpp>
#include <string>

namespace molmesh::formats {

/// Changes `text`. gemmi's own reader of mmJSON runs off its memory on empty columns. Throws Error(bad_input)
/// "FILE:LINE: …".
gemmi::cif::Document read_mmjson(std::string& text, const std::string& file);

} // namespace molmesh::formats
