// sha256.hpp — SHA-256 of a byte string (FIPS 180-4), for the source line of a .hier.
#pragma once
#include <string>
#include <string_view>

namespace molmesh::formats {

/// 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

} // namespace molmesh::formats
