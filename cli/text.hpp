// text.hpp — lines of UTF-8 text for a terminal.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace molmesh::cli {

/// One printable line: control characters and bytes that are no UTF-8 become \xHH, line ends "; "; 2,000 bytes at
/// most.
std::string one_line(const std::string& text);

/// "1 body", "40 cavities"
std::string counted(int64_t n, const std::string& one, const std::string& several);

/// Columns that the text takes; every character is as wide as a Latin letter.
size_t columns(const std::string& text);

/// The words of a text in lines of at most `width` columns; a longer word has a line of its own.
std::vector<std::string> wrapped(const std::string& text, size_t width);

} // namespace molmesh::cli
