// small_letters.hpp — ASCII letters of any case as small ones, whatever the locale.
#pragma once
#include <string>

namespace molmesh {

inline char small_letter(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

inline std::string small_letters(std::string text) {
  for (char& c : text)
    c = small_letter(c);
  return text;
}

} // namespace molmesh
