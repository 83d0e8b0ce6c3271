// optimization_report.hpp — angles of a mesh, and how near its surface is, for the run report.
#pragma once
#include "cli/value.hpp"
#include "optimize/mesh/measures.hpp"

namespace molmesh {

inline cli::Value angles_value(const optimize::Angles& a) {
  return {{"min_dihedral", a.min}, {"max_dihedral", a.max}, {"below_25", a.below_25}, {"above_140", a.above_140}};
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
