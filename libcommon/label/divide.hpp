// divide.hpp — divides the molecule in a mesh into regions, one for each owner, along the faces of equal shares.
#pragma once
#include "label/label.hpp"
#include "mesh/tet_mesh.hpp"
#include <array>
#include <map>
#include <vector>

namespace molmesh::label {

/// Region of group 0 of the level; the others follow.
inline constexpr int32_t first_domain = Region::cavity + 1;

struct Division {
  std::vector<int32_t> group;                        ///< those that own a vertex, ascending
  std::map<int32_t, std::array<int32_t, 2>> between; ///< label of an interface: its two groups, ascending
};

/// Region 1 becomes regions first_domain + group: every vertex belongs to the group with the largest share there.
/// Edges between vertices of different groups get a point where the two shares are equal, faces of three groups and
/// tetrahedra of four a point inside, and tetrahedra are divided by these: each piece has vertices of one group. So
/// each region is the neighbourhood of a set of vertices in a subdivision of the mesh, and its boundary is a closed
/// 2-manifold where that of region 1 is (docs/theory/meshing.md §10). Tetrahedra of other regions that have such an
/// edge or face on the surface are divided too; no point of the mesh moves. Faces between two groups become
/// triangles with labels of their own, above the mesh's, in the order of the pairs; they point out of the lower
/// group. Same result at any number of threads. Throws Error(bad_input) for a mesh without region 1.
Division divide(TetMesh& m, const ShareFinder& shares, int threads);

} // namespace molmesh::label
