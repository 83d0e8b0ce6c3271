// cavity_walls.cpp — parts of the surface by their points, and the sign of the volume within each.
#include "mesh/cavity_walls.hpp"
#include "mesh/disjoint_sets.hpp"

namespace molmesh {

std::vector<uint8_t> cavity_walls(const TetMesh& m) {
  DisjointSets part(m.point.size()); // named by its first point
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] == Boundary::surface)
      for (const int32_t p : m.tri[t])
        part.join(m.tri[t][0], p);
  std::vector<double> volume(m.point.size(), 0);
  std::vector<uint8_t> cut(m.point.size(), 0);
  for (size_t t = 0; t < m.tri.size(); ++t) {
    const Tri& v = m.tri[t];
    const int32_t first = part.first(v[0]);
    if (m.boundary[t] == Boundary::surface) {
      const Vec3d origin = m.point[first]; // near the part: less is lost
      volume[first] += dot(m.point[v[0]] - origin, cross(m.point[v[1]] - origin, m.point[v[2]] - origin)) / 6;
    } else if (m.boundary[t] >= Boundary::box_x0 && m.boundary[t] <= Boundary::box_z1)
      for (const int32_t p : v)
        cut[part.first(p)] = 1;
  }
  std::vector<uint8_t> wall(m.tri.size(), 0);
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (const int32_t first = part.first(m.tri[t][0]);
        m.boundary[t] == Boundary::surface && volume[first] < 0 && !cut[first])
      wall[t] = 1;
  return wall;
}

} // namespace molmesh
