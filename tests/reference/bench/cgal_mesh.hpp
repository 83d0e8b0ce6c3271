// cgal_mesh.hpp — CGAL Mesh_3 on a function.
#pragma once
#include "mesh/tet_mesh.hpp"
#include <functional>

namespace molmesh::reference {

struct CgalSizes {
  double facet = 1, facet_distance = 0.25, cell = 1; ///< Å
  bool optimized = false;                            ///< perturber and exuder
};

/// Tetrahedra where inside(x) > 0, within the sphere. No triangles.
TetMesh cgal_mesh(const std::function<double(Vec3d)>& inside, Vec3d center, double radius, const CgalSizes& sizes);

} // namespace molmesh::reference
