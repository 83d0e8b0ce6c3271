// validity_duplicates.hpp — finds points and tetrahedra that occur twice.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// [points] An earlier point with the same coordinates (exact; 0 and -0 are equal), or -1.
std::vector<int32_t> point_twins(const std::vector<Vec3d>& point, int threads);

/// Tetrahedra with the same four points as an earlier one, ascending. across: face_neighbors.
std::vector<int64_t> tet_copies(const TetMesh& m, const LargeArray<int32_t>& across);

} // namespace molmesh
