// mesh_bodies.hpp — finds the connected parts of every region: bodies, cavities, pieces of the outside.
#pragma once
#include "mesh/adjacency.hpp"

namespace molmesh {

/// Tetrahedra of one region that faces connect.
struct MeshBody {
  int32_t region = 0;
  int64_t tets = 0;
  double volume = 0; ///< Å³
  double area = 0;   ///< Å², of all its faces towards other regions or nothing
  Vec3d centre;      ///< of its volume, Å
  Vec3d low, high;   ///< its box, Å
};

struct MeshBodies {
  std::vector<MeshBody> body; ///< by region, then largest volume first, then first tetrahedron first
  LargeArray<int32_t> of;     ///< [tets] index of its body
};

/// across: face_neighbors of the mesh. Same result at any number of threads.
MeshBodies find_bodies(const TetMesh& m, const LargeArray<int32_t>& across);

/// The box of the bodies of these regions: low, high.
std::array<Vec3d, 2> box_of(const MeshBodies& bodies, const std::vector<int32_t>& region);

} // namespace molmesh
