// gunzip.hpp — gzip in memory (RFC 1952).
#pragma once
#include <string>
#include <string_view>

namespace molmesh::formats {

bool is_gzip(std::string_view bytes);
/// All members of a gzip file, one after the other; zero padding behind the last is allowed. Throws
/// Error(bad_input) when it is truncated, damaged (checksum) or followed by something else. `file` is for messages.
std::string gunzip(std::string_view bytes, const std::string& file);

} // namespace molmesh::formats
