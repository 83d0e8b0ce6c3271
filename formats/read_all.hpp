// read_all.hpp — all bytes of a stream.
#pragma once
#include <iosfwd>
#include <string>

namespace molmesh::formats {

/// Throws Error(bad_input), which names `file`, where reading breaks off.
std::string read_all(std::istream& in, const std::string& file);

} // namespace molmesh::formats
