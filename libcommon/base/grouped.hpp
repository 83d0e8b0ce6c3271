// grouped.hpp — a whole number as people read it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace molmesh {

/// 1234567 → 1,234,567
inline std::string grouped(int64_t n) {
  std::string s = std::to_string(n);
  for (auto at = static_cast<std::ptrdiff_t>(s.size()) - 3; at > (n < 0 ? 1 : 0); at -= 3)
    s.insert(static_cast<size_t>(at), 1, ',');
  return s;
}

} // namespace molmesh
