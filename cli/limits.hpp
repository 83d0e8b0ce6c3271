// limits.hpp — the quality asked for, the same options in every tool that judges a mesh.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace molmesh::cli {

/// --min-dihedral and --max-dihedral, in degrees. and_aim: what a tool does for them besides.
inline void add_dihedral_limits(CLI::App& app, double& min, double& max, const std::string& and_aim = "") {
  app.add_option("--min-dihedral", min, "quality asked for: status 5 when an angle is smaller" + and_aim)
      ->type_name("°")
      ->check(CLI::Range(0., 70.5));
  app.add_option("--max-dihedral", max, "quality asked for: status 5 when an angle is larger" + and_aim)
      ->type_name("°")
      ->check(CLI::Range(70.6, 180.));
}

} // namespace molmesh::cli
