// gunzip.hpp — gzip in memory (RFC 1952).
#pragma once
#include <string>
#include <string_view>

namespace molmesh::formats {

bool is_gzip(std::string_view bytes);
/// Bytes that a gzip file of this size may unpack to: text of structures is 4 to 10 times its packed size, zeros
/// 1000.
constexpr size_t most_unpacked(size_t packed) {
  return 20 * packed + (size_t{64} << 20);
}
/// All members of a gzip file, one after the other; zero padding behind the last is allowed. Throws
/// Error(bad_input) when it is truncated, damaged (checksum), followed by something else or
/// larger than most_unpacked(), which is found before any memory is taken for it. `file` is for messages.
std::string gunzip(std::string_view bytes, const std::string& file);

} // namespace molmesh::formats
