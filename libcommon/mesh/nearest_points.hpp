// nearest_points.hpp — the point of a mesh that is nearest to a place.
#pragma once
#include "mesh/tet_mesh.hpp"
#include <span>

namespace molmesh {

struct NearestPoint {
  int64_t point = -1;  ///< of the mesh, from 0; -1: it has none
  double distance = 0; ///< Å
};

/// One for each place (Å); of points equally near the lowest.
std::vector<NearestPoint> nearest_points(const TetMesh& m, std::span<const Vec3d> place);

} // namespace molmesh
