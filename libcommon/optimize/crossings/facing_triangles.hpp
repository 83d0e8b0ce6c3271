// facing_triangles.hpp — finds the triangles on the end of a mesh that face others so near that they might cross.
#pragma once
#include "isosurface/target.hpp"
#include "optimize/crossings/free_triangles.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// Where the mesh ends in curved surfaces, in its order.
std::vector<FreeTriangle> find_free_triangles(const DynamicMesh& m, int threads);

/// A few of their edges, for FreeTriangles (Å).
double cell_for(const std::vector<FreeTriangle>& triangles);

/// In Å.
struct FacingDistance {
  double apart;             ///< of two triangles, beside what either is off the target
  double kept;              ///< triangles come to be no farther off than this, or than they are
  bool none_is_off = false; ///< all are triangles of the target
};

/// Which of them face another one as near as that, one each.
std::vector<uint8_t> facing(const std::vector<Vec3d>& point, const std::vector<FreeTriangle>& triangle,
                            const Target& target, const FacingDistance& distance, int threads);

} // namespace molmesh::optimize
