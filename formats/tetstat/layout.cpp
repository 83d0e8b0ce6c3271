// layout.cpp — numbers and words for reports on a terminal.
#include "formats/tetstat/layout.hpp"
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace molmesh::formats {

std::string print(const char* format, ...) {
  char buffer[512];
  va_list args;
  va_start(args, format);
  std::vsnprintf(buffer, sizeof buffer, format, args);
  va_end(args);
  return buffer;
}

std::string amount(double v) {
  if (std::isnan(v))
    return "-";
  if (!(std::fabs(v) < 1e15))
    return print("%.6g", v);
  if (v != 0 && std::fabs(v) < 0.1)
    return print("%.2g", v);
  const int64_t hundredths = std::llround(std::fabs(v) * 100);
  std::string s = v < 0 && hundredths > 0 ? "-" : "";
  s += grouped(hundredths / 100);
  return s += print(".%02d", static_cast<int>(hundredths % 100));
}

std::string plain(std::string s) {
  for (char& c : s)
    if (static_cast<unsigned char>(c) < 32 || c == 127)
      c = '?';
  return s;
}

size_t columns(const std::string& s) {
  return static_cast<size_t>(std::count_if(s.begin(), s.end(), [](unsigned char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& s, size_t width) {
  return s + std::string(width - std::min(width, columns(s)), ' ');
}

} // namespace molmesh::formats
