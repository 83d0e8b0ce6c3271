// mesh_line.hpp — a mesh in the words of a summary line.
#pragma once
#include "base/grouped.hpp"
#include "cli/text.hpp"
#include "mesh/overview.hpp"
#include <cmath>
#include <cstdio>

namespace molmesh {

/// "molecule 90,603 Å³, surface 12,345 Å², angles 25.2° to 139.1°"; what is not there is left out.
inline std::string mesh_line(const TetMesh& mesh, int threads) {
  const Overview o = overview(mesh, threads);
  const auto rounded = [](double x) { return x < 100 ? std::to_string(x).substr(0, 4) : grouped(std::llround(x)); };
  std::string line;
  if (o.volume > 0)
    line += "molecule " + rounded(o.volume) + " Å³, ";
  if (o.area > 0)
    line += "surface " + rounded(o.area) + " Å², ";
  char angles[64];
  std::snprintf(angles, sizeof angles, "angles %.1f° to %.1f°", o.least_angle, o.largest_angle);
  return line + angles;
}

} // namespace molmesh
