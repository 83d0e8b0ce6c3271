// load.hpp — an OpenVDB grid to a dense map, by the library itself.
#pragma once
#include "formats/openvdb/openvdb.hpp"

namespace molmesh::formats {

/// As read_openvdb(), in this process.
ForeignGrid load_openvdb(std::string_view bytes, const std::string& name, const std::string& file);

} // namespace molmesh::formats
