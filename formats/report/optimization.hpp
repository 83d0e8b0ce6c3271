// optimization.hpp — what was improved, and how near the surface is, as JSON for the run report (formats/report).
#pragma once
#include "optimize/mesh/measures.hpp"
#include <nlohmann/json.hpp>

namespace molmesh::optimize {

inline nlohmann::ordered_json json(const Angles& a) {
  return {{"min_dihedral", a.min}, {"max_dihedral", a.max}, {"below_25", a.below_25}, {"above_140", a.above_140}};
}
inline nlohmann::ordered_json json(const Fidelity& f) {
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

} // namespace molmesh::optimize
