// meshes.hpp — small meshes of which everything is known.
#pragma once
#include "geom/tet_measures.hpp"
#include "mesh/adjacency.hpp"
#include <functional>

namespace molmesh::testing {

/// n³ unit cubes of edge h from `origin`, six tetrahedra each (Kuhn), regions by cube; box sides labeled.
inline TetMesh cubes(int n, const std::function<int32_t(Vec3i)>& region, double h = 1, Vec3d origin = {0, 0, 0}) {
  TetMesh m;
  const auto id = [n](int i, int j, int k) { return (i * (n + 1) + j) * (n + 1) + k; };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        m.point.push_back(origin + h * to_double(Vec3i{i, j, k}));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
        for (int p = 0; p < 6; ++p) {
          Vec3i v{i, j, k};
          Tet t{};
          t[0] = id(v.x, v.y, v.z);
          for (size_t s = 0; s < 3; ++s) {
            ++v[order[p][s]];
            t[s + 1] = id(v.x, v.y, v.z);
          }
          if (p >= 3)
            std::swap(t[2], t[3]);
          m.tet.push_back(t);
          m.region.push_back(region({i, j, k}));
        }
      }
  rebuild_triangles(m);
  const LargeArray<int32_t> across = face_neighbors(m, 1);
  for (size_t t = 0; t < m.tri.size(); ++t)
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        const double wall = origin[axis] + (side ? h * n : 0.0);
        bool on = true;
        for (int32_t v : m.tri[t])
          on &= m.point[v][axis] == wall;
        if (on)
          m.boundary[t] = Boundary::box_x0 + 2 * axis + side;
      }
  // Rebuilt surface triangles look out of region 1 even where it is not; box triangles look out of the box.
  for (size_t t = 0; t < m.tri.size(); ++t) {
    if (m.boundary[t] == Boundary::surface)
      continue;
    const Vec3d a = m.point[m.tri[t][0]];
    const Vec3d normal = tri_normal(a, m.point[m.tri[t][1]], m.point[m.tri[t][2]]);
    const int side = m.boundary[t] - Boundary::box_x0;
    if ((normal[side / 2] > 0) != (side % 2 == 1))
      std::swap(m.tri[t][1], m.tri[t][2]);
  }
  return m;
}

/// The tetrahedra of some regions alone, points renumbered; box labels kept, new faces are surface.
inline TetMesh extract(const TetMesh& m, const std::function<bool(int32_t)>& keep) {
  TetMesh out;
  std::vector<int32_t> number(m.point.size(), -1);
  const auto renumber = [&](int32_t v) {
    int32_t& n = number[v];
    if (n < 0) {
      n = static_cast<int32_t>(out.point.size());
      out.point.push_back(m.point[v]);
    }
    return n;
  };
  for (size_t i = 0; i < m.tet.size(); ++i) {
    if (!keep(m.region[i]))
      continue;
    Tet t = m.tet[i];
    for (int32_t& v : t)
      v = renumber(v);
    out.tet.push_back(t);
    out.region.push_back(m.region[i]);
  }
  for (size_t t = 0; t < m.tri.size(); ++t) {
    Tri x = m.tri[t];
    bool all = true;
    for (int32_t& v : x)
      all &= (v = number[v]) >= 0;
    if (!all)
      continue;
    out.tri.push_back(x);
    out.boundary.push_back(m.boundary[t]);
  }
  return out;
}

/// The sum over the elements of a region.
inline double volume(const TetMesh& m, int32_t region) {
  double sum = 0;
  for (size_t t = 0; t < m.tet.size(); ++t)
    if (m.region[t] == region)
      sum += tet_volume(m.point[m.tet[t][0]], m.point[m.tet[t][1]], m.point[m.tet[t][2]], m.point[m.tet[t][3]]);
  return sum;
}

inline int32_t all_molecule(Vec3i) {
  return Region::molecule;
}

} // namespace molmesh::testing
