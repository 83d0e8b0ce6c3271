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

} // namespace molmesh::formats
