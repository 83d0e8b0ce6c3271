// layout.hpp — numbers and words for reports on a terminal.
#pragma once
#include <cstdint>
#include <string>

namespace molmesh::formats {

[[gnu::format(printf, 1, 2)]] std::string print(const char* format, ...);
/// 1234567 → 1,234,567
std::string grouped(int64_t n);
/// Å² or Å³ with two decimals, grouped; NaN is a dash.
std::string amount(double v);
/// Text of a file on one line: control characters become question marks.
std::string plain(std::string s);

} // namespace molmesh::formats
