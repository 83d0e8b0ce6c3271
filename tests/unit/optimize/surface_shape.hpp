// surface_shape.hpp — the molecular surface's points, edges and triangles, counted one by one.
#pragma once
#include "mesh/tet_mesh.hpp"
#include <algorithm>
#include <set>
#include <utility>

namespace molmesh::test {

struct SurfaceShape {
  std::set<int32_t> points;
  std::set<std::pair<int32_t, int32_t>> edges;
  int64_t triangles = 0;
  int64_t euler() const { return int64_t(points.size()) - int64_t(edges.size()) + triangles; }
};

inline SurfaceShape surface_shape(const TetMesh& mesh) {
  SurfaceShape s;
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    for (size_t i = 0; i < 3 && mesh.boundary[t] == Boundary::surface; ++i) {
      const int32_t a = mesh.tri[t][i], b = mesh.tri[t][(i + 1) % 3];
      s.points.insert(a);
      s.edges.insert({std::min(a, b), std::max(a, b)});
      s.triangles += i == 0;
    }
  return s;
}

} // namespace molmesh::test
