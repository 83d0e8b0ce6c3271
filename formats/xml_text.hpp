// xml_text.hpp — names as values of XML's attributes.
#pragma once
#include <string>

namespace molmesh::formats {

/// Entities in names of foreign files were not resolved, so `&` is left alone.
inline std::string escaped(const std::string& name) {
  std::string s;
  for (const char c : name)
    s += c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return s;
}

} // namespace molmesh::formats
