// text.cpp — lines of UTF-8 text for a terminal.
#include "cli/text.hpp"
#include "base/grouped.hpp"
#include <algorithm>
#include <cstdio>
#include <sstream>

namespace molmesh::cli {

std::string one_line(const std::string& text) {
  std::string line;
  for (size_t i = 0; i < text.size() && line.size() < 2000;) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const size_t length = byte < 0x80                   ? 1
                          : byte >= 0xC2 && byte < 0xE0 ? 2
                          : byte >= 0xE0 && byte < 0xF0 ? 3
                          : byte >= 0xF0 && byte < 0xF5 ? 4
                                                        : 0;
    bool valid = length > 0 && i + length <= text.size() && byte >= 0x20 && byte != 0x7F;
    for (size_t k = 1; valid && k < length; ++k)
      valid = (static_cast<unsigned char>(text[i + k]) & 0xC0) == 0x80;
    if (valid) {
      line.append(text, i, length);
      i += length;
    } else {
      char hex[8];
      std::snprintf(hex, sizeof hex, "\\x%02x", byte);
      line += text[i] == '\n' && i + 1 == text.size() ? "" : text[i] == '\n' ? "; " : hex;
      ++i;
    }
  }
  return line;
}

std::string counted(int64_t n, const std::string& one, const std::string& several) {
  return molmesh::grouped(n) + ' ' + (n == 1 ? one : several);
}

size_t columns(const std::string& text) {
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::vector<std::string> wrapped(const std::string& text, size_t width) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;)
    if (lines.empty() || columns(lines.back()) + 1 + columns(word) > width)
      lines.push_back(word);
    else
      lines.back() += ' ' + word;
  return lines;
}

} // namespace molmesh::cli
