// adjacency.cpp — groups faces by their three points.
#include "mesh/adjacency.hpp"
#include "mesh/face_groups.hpp"
#include <algorithm>

namespace molmesh {

LargeArray<int32_t> face_neighbors(const TetMesh& m, int threads) {
  const auto faces = static_cast<int64_t>(4 * m.tet.size());
  LargeArray<int32_t> across(static_cast<size_t>(faces), no_face);
  for_each_face(m.tet, {}, static_cast<int64_t>(m.point.size()), threads, [&](const uint32_t* face, int n, bool) {
    if (n == 2) {
      across[face[0]] = static_cast<int32_t>(face[1]);
      across[face[1]] = static_cast<int32_t>(face[0]);
    }
    for (int i = 0; n > 2 && i < n; ++i)
      across[face[i]] = crowded_face;
  });
  return across;
}

std::vector<int64_t> boundary_faces(const TetMesh& m, const LargeArray<int32_t>& across, int threads) {
  constexpr int64_t chunk = 1 << 16;
  const auto faces = static_cast<int64_t>(across.size()), chunks = (faces + chunk - 1) / chunk;
  std::vector<std::vector<int64_t>> part(static_cast<size_t>(chunks));
  par::for_n(chunks, threads, 1, [&](int64_t c) {
    for (int64_t f = c * chunk; f < std::min(faces, (c + 1) * chunk); ++f)
      if (across[f] != crowded_face && region_across(m, across, f) != m.region[f / 4])
        part[c].push_back(f);
  });
  std::vector<int64_t> boundary;
  for (const auto& p : part)
    boundary.insert(boundary.end(), p.begin(), p.end());
  return boundary;
}

void rebuild_triangles(TetMesh& m, int threads) {
  m.tri.clear();
  const RegionOrder order(m);
  const LargeArray<int32_t> across = face_neighbors(m, threads);
  for (int64_t face : boundary_faces(m, across, threads)) {
    const int32_t region = m.region[face / 4], other = region_across(m, across, face);
    if (other != 0 && !order.is_first(region, other))
      continue; // the first region owns the triangle
    Tri t = face_points(m, face);
    if (!triangle_looks_out(order, region, other, Boundary::surface))
      std::swap(t[1], t[2]);
    m.tri.push_back(t);
  }
  m.boundary.assign(m.tri.size(), Boundary::surface);
}

void label_walls(TetMesh& m, int threads) {
  if (std::all_of(m.region.begin(), m.region.end(), [&](int32_t r) { return r == m.region[0]; }))
    return;
  Vec3d low = m.point[m.tet[0][0]], high = low;
  for (const Tet& t : m.tet)
    for (int32_t v : t)
      for (int a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], m.point[v][a]);
        high[a] = std::max(high[a], m.point[v][a]);
      }
  const RegionOrder order(m);
  const auto wall = [&](const Tri& t, int side) {
    return std::all_of(t.begin(), t.end(),
                       [&](int32_t v) { return m.point[v][side / 2] == (side % 2 == 0 ? low : high)[side / 2]; });
  };
  const LargeArray<int32_t> across = face_neighbors(m, threads);
  size_t next = 0; // as rebuild_triangles counts them
  for (int64_t face : boundary_faces(m, across, threads)) {
    const int32_t region = m.region[face / 4], other = region_across(m, across, face);
    if (other != 0 && !order.is_first(region, other))
      continue;
    const size_t t = next++;
    for (int side = 0; side < 6 && across[face] == no_face; ++side)
      if (wall(m.tri[t], side)) {
        m.tri[t] = face_points(m, face);
        m.boundary[t] = Boundary::box_x0 + side;
        break;
      }
  }
}

} // namespace molmesh
