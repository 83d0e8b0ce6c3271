// crowded.hpp — which triangles, where a mesh ends in a curved surface, have another sheet before them so near that
// they might come to cross it.
#pragma once
#include "isosurface/target.hpp"
#include "optimize/crossings/sheets.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// Where the mesh ends in curved surfaces, in its order.
std::vector<SheetTriangle> end_triangles(const DynamicMesh& m, int threads);

/// A few of their edges, for Sheets (Å).
double cell_for(const std::vector<SheetTriangle>& triangles);

/// In Å.
struct FacingDistance {
  double apart; ///< of two triangles, beside what either is off the target
  double kept;  ///< triangles come to be no farther off than this, or than they are
};

/// Which of them face another one as near as that, one each.
std::vector<uint8_t> facing(const std::vector<Vec3d>& point, const std::vector<SheetTriangle>& triangle,
                            const Target& target, const FacingDistance& distance, int threads);

} // namespace molmesh::optimize
