// layout.hpp — numbers and words for reports on a terminal.
#pragma once
#include "base/grouped.hpp"
#include <string>

namespace molmesh::formats {

[[gnu::format(printf, 1, 2)]] std::string print(const char* format, ...);
/// Å² or Å³ with two decimals, grouped; below 0.1 with two digits that count; NaN is a dash.
std::string amount(double v);
/// Text of a file on one line: control characters become question marks.
std::string plain(std::string s);
/// Characters of UTF-8, which a terminal shows in as many columns.
size_t columns(const std::string& s);
/// With blanks behind it, so many columns wide at the least.
std::string padded(const std::string& s, size_t width);

} // namespace molmesh::formats
