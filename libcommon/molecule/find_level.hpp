// find_level.hpp — a level of a hierarchy by its name.
#pragma once
#include "molecule/hierarchy.hpp"
#include <string_view>

namespace molmesh {

/// Its index; the number of levels where there is none.
inline size_t find_level(const Hierarchy& h, std::string_view name) {
  size_t l = 0;
  while (l < h.level.size() && h.level[l].name != name)
    ++l;
  return l;
}

} // namespace molmesh
