// oracles.hpp — what CGAL and TetGen say about a surface of triangles.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh::reference {

/// CGAL 5.5: exact predicates, inexact constructions.
struct CgalSurface {
  bool manifold = false; ///< the soup is a polygon mesh; nothing below is known otherwise
  bool closed = false;
  bool bounds_volume =
      false; ///< components lie in each other with orientations that alternate; asked of closed surfaces
  int64_t crossings = 0; ///< pairs of triangles that cross, exact
  int64_t components = 0, euler = 0;
  double area = 0, volume = 0;
};
CgalSurface cgal_surface(const std::vector<Vec3d>& point, const std::vector<Tri>& tri);

/// TetGen 1.5 fills the closed surface, its triangles kept as they are. Points of no triangle are left out;
/// `holes`: a point in each cavity that stays empty; `quality`: further switches, as "q1.4a0.5" (radius to edge
/// ratio, largest volume). Throws std::runtime_error when TetGen gives up, as it does on a surface that crosses
/// itself.
TetMesh tetgen_fill(const std::vector<Vec3d>& point, const std::vector<Tri>& tri,
                    const std::vector<Vec3d>& holes = {}, const std::string& quality = "");

} // namespace molmesh::reference
