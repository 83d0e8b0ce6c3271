// shortest.hpp — a number in the fewest digits that tell it from all others.
#pragma once
#include <array>
#include <charconv>
#include <string>

namespace molmesh {

/// 0.1 → 0.1, 1e300 → 1e+300, which std::to_string writes in 300 digits.
inline std::string shortest(double v) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), v).ptr};
}

} // namespace molmesh
