// centroid.hpp — the middle of a cell.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Of a cell as cell arrays count them: tetrahedra first, then triangles (Å).
inline Vec3d cell_centroid(const TetMesh& m, size_t cell) {
  const auto p = [&](int32_t v) { return m.point[v]; };
  if (cell < m.tet.size()) {
    const Tet& t = m.tet[cell];
    return 0.25 * (p(t[0]) + p(t[1]) + p(t[2]) + p(t[3]));
  }
  const Tri& t = m.tri[cell - m.tet.size()];
  return (p(t[0]) + p(t[1]) + p(t[2])) / 3.0;
}

} // namespace molmesh
