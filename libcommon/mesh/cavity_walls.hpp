// cavity_walls.hpp — finds the triangles of the molecular surface that face closed cavities.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// [triangles] 1: of the molecular surface (boundary 1), on a closed connected part of it that encloses less than
/// nothing, V = Σ p0 · (p1 × p2) / 6 < 0, as triangles point out of the molecule. Parts that the box cuts are not
/// closed. The outside of a body within a cavity is none of its walls. The cavity need not be meshed.
std::vector<uint8_t> cavity_walls(const TetMesh& m);

} // namespace molmesh
