// test_data.hpp — finds real structures that the repository does not hold (-DMOLMESH_TEST_DATA=DIR).
#pragma once
#include <cstdlib>
#include <filesystem>
#include <iostream>

namespace molmesh::test {

/// DIR/folder; empty, after saying so, where it is not there.
inline std::filesystem::path data(const char* folder) {
  const char* const root = std::getenv("MOLMESH_TEST_DATA");
  if (!root || !*root) {
    std::cout << "SKIPPED: needs real structures (-DMOLMESH_TEST_DATA=DIR)\n";
    return {};
  }
  const auto path = std::filesystem::path(root) / folder;
  if (std::filesystem::is_directory(path))
    return path;
  std::cout << "SKIPPED: no " << path << '\n';
  return {};
}

} // namespace molmesh::test
