// text.hpp — percent-encoded names, UTF-8 and names of levels, as HIERv1.md has them.
#pragma once
#include <string>
#include <string_view>

namespace molmesh::formats {

/// Appends `name` with white space, control characters, '%' and bytes that are not UTF-8 as %XX.
void percent_encode(std::string& out, std::string_view name);
/// False when a '%' is not followed by two hexadecimal digits.
bool percent_decode(std::string_view text, std::string& name);
/// Length of the UTF-8 character that `text` begins with, 0 when it is none.
size_t utf8_length(std::string_view text);
/// A word of letters, digits, _ and - that is no record's in this version, 1 or 2.
bool is_level_name(std::string_view word, int version);

} // namespace molmesh::formats
