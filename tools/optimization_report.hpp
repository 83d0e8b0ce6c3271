// optimization_report.hpp — angles of a mesh, and how near its surface is, for the run report.
#pragma once
#include "cli/value.hpp"
#include "optimize/mesh/measures.hpp"
#include <cstdio>
#include <string>

namespace molmesh {

inline cli::Value angles_value(const optimize::Angles& a) {
  return {{"min_dihedral", a.min}, {"max_dihedral", a.max}, {"below_25", a.below_25}, {"above_140", a.above_140}};
}

/// Of what the isosurface encloses.
inline double missing_share(const optimize::Fidelity& f) {
  return f.volume > 0 ? f.missing / (f.volume + f.missing) : 0;
}

/// "1.3 %"
inline std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * share);
  return text;
}

inline cli::Value fidelity_value(const optimize::Fidelity& f) {
  return {{"points", f.points},
          {"points_off", f.points_off},
          {"points_off_cavity", f.points_off_cavity},
          {"points_off_wall", f.points_off_wall},
          {"triangles", f.triangles},
          {"centroids_off", f.centroids_off},
          {"turned_45", f.turned},
          {"area", f.area},
          {"volume", f.volume},
          {"volume_missing", f.missing}};
}

} // namespace molmesh
