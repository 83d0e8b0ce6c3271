// mesh_code.hpp — a tetrahedral mesh in a few bits an element, for pages (HTML.md).
#pragma once
#include "formats/vtu/cell_labels.hpp"
#include <string>

namespace molmesh::formats {

/// One part of the code, not yet compressed.
struct CodeStream {
  std::string name, bytes;
};

struct MeshCode {
  int64_t points = 0, tets = 0;   ///< that it holds
  double quantum = 1;             ///< Å, a power of two: coordinates are rounded to its multiples
  Vec3d origin;                   ///< Å
  std::vector<int64_t> body_tets; ///< [bodies] tetrahedra that it holds of each; they follow each other
  std::vector<CodeStream> stream;
  LargeArray<int32_t> place; ///< [tets of the mesh] number in the code, -1: left out
};

/// Every triangle with its tetrahedra is held, and the tetrahedra of `keep` ([tets], 1: yes; empty: all). Same
/// mesh, same bytes.
MeshCode encode_mesh(const TetMesh& m, const TriangleSides& sides, const MeshBodies& bodies,
                     const std::vector<uint8_t>& keep, const std::vector<CellLabel>& labels);

} // namespace molmesh::formats
