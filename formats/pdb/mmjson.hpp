// mmjson.hpp — mmJSON (PDBj): the categories of mmCIF as JSON arrays.
#pragma once
#include <gemmi/cifdoc.hpp>
#include <string>

namespace molmesh::formats {

class AtomSite;

/// The atoms of the first block that has them go to `atoms`. Changes `text`. gemmi's own reader of mmJSON runs off
/// its memory on empty columns. Throws Error(bad_input) "FILE:LINE: …".
gemmi::cif::Document read_mmjson(std::string& text, const std::string& file, AtomSite& atoms);

} // namespace molmesh::formats
