// foreign.hpp — formats of structures that are not read, told by their first bytes.
#pragma once
#include <string>
#include <string_view>

namespace molmesh::formats {

/// Throws Error(bad_input), which names the format and a program that converts it, where the bytes are of a known
/// one that is not read.
void refuse_foreign(std::string_view bytes, const std::string& file);

} // namespace molmesh::formats
