// partition.hpp — divides tetrahedra into parts of equal size with few faces between them (METIS).
// Numbers the elements of the output, for solvers; the threads of tetsmooth share out optimize/mesh/parts.hpp
// instead.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Of large meshes compact clusters of tetrahedra go to METIS: those of a 256th of the mesh's extent as they come.
/// Parts of fewer than 20 tetrahedra are runs of equal length along a Hilbert curve.
/// [tets] Part, 0 … parts - 1, of the dual graph (tetrahedra that share a face), by METIS k-way with a fixed seed.
/// Exactly as many parts as asked for, or as tetrahedra where those are fewer; none is empty. across [4 tets]: the
/// tetrahedron on the other side of each face, -1: none; found here when empty. Same result at
/// any number of threads. Throws Error(failed) when METIS gives up.
std::vector<int32_t> partition(const TetMesh& m, int parts, int threads, LargeArray<int32_t> across = {});

} // namespace molmesh
