// openvdb.hpp — grids of other programs in OpenVDB files, by the OpenVDB library (OPENVDB.md).
#pragma once
#include "compose/dense_map.hpp"
#include <string>
#include <string_view>

namespace molmesh::formats {

/// Whether this is built with the library.
bool has_openvdb();

struct ForeignGrid {
  compose::DenseMap map; ///< of a level set the distances with the sign turned over: positive inside
  bool level_set = false;
  std::string name;
};

/// The grid of that name, or the only one of numbers where the name is empty. The library runs in a process of its
/// own with limits on time and memory, since it may crash or hang on damaged files. Throws Error(bad_input), and
/// Error(mode_unavailable) without the library.
ForeignGrid read_openvdb(std::string_view bytes, const std::string& name, const std::string& file);

} // namespace molmesh::formats
