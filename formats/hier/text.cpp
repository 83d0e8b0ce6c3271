// text.cpp — percent-encoding, byte by byte.
#include "formats/hier/text.hpp"
#include "molecule/words.hpp"
#include <algorithm>

namespace molmesh::formats {
namespace {

int hex_value(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                : -1;
}

} // namespace

size_t utf8_length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [&](size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
  const unsigned a = byte(0), b = byte(1);
  if (text.empty())
    return 0;
  if (a < 0x80)
    return 1;
  if (a >= 0xC2 && a <= 0xDF)
    return follows(1) ? 2 : 0;
  if (a >= 0xE0 && a <= 0xEF) { // no overlong forms, no surrogates
    const bool good = follows(1) && follows(2) && !(a == 0xE0 && b < 0xA0) && !(a == 0xED && b > 0x9F);
    return good ? 3 : 0;
  }
  if (a >= 0xF0 && a <= 0xF4) {
    const bool good =
        follows(1) && follows(2) && follows(3) && !(a == 0xF0 && b < 0x90) && !(a == 0xF4 && b > 0x8F);
    return good ? 4 : 0;
  }
  return 0;
}

void percent_encode(std::string& out, std::string_view name) {
  static const char digits[] = "0123456789ABCDEF";
  for (size_t i = 0; i < name.size();) {
    const auto c = static_cast<unsigned char>(name[i]);
    const size_t length = utf8_length(name.substr(i));
    if (c <= 0x20 || c == 0x7F || c == '%' || length == 0) {
      out += {'%', digits[c >> 4], digits[c & 15]};
      ++i;
    } else {
      out.append(name, i, length);
      i += length;
    }
  }
}

bool percent_decode(std::string_view text, std::string& name) {
  name.clear();
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      name += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hex_value(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hex_value(text[i + 2]) : -1;
    if (high < 0 || low < 0)
      return false;
    name += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return true;
}

bool is_level_name(std::string_view word, int version) {
  static constexpr std::string_view reserved[] = {"hier", "source", "levels", "atom"};
  const bool plain = std::all_of(word.begin(), word.end(),
                                 [](char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-'; });
  return plain && !word.empty() && (version == 1 || word != "body") &&
         std::find(std::begin(reserved), std::end(reserved), word) == std::end(reserved);
}

} // namespace molmesh::formats
