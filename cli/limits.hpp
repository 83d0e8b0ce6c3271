// limits.hpp — the quality asked for, the same options in every tool that judges a mesh.
#pragma once
#include "cli/options.hpp"
#include <string>

namespace molmesh::cli {

/// --min-dihedral and --max-dihedral, in degrees. and_aim: what a tool does for them besides.
inline void add_dihedral_limits(Table& table, double& min, double& max, const std::string& and_aim = "") {
  table.add("--min-dihedral", min, "quality asked for: status 5 when an angle is smaller" + and_aim)
      .unit("°")
      .within(0, 70.5);
  table.add("--max-dihedral", max, "quality asked for: status 5 when an angle is larger" + and_aim)
      .unit("°")
      .within(70.6, 180);
}

} // namespace molmesh::cli
