// adjacency.cpp — faces are grouped by their three points.
#include "mesh/adjacency.hpp"
#include "mesh/group.hpp"
#include <utility>

namespace molmesh {

std::vector<int32_t> face_neighbors(const TetMesh& m, int threads) {
  const auto faces = static_cast<int64_t>(4 * m.tet.size());
  std::vector<int32_t> across(static_cast<size_t>(faces), no_face);
  const auto key = [&](int64_t face) {
    auto [a, b, c] = face_points(m, face);
    if (a > b)
      std::swap(a, b);
    if (b > c)
      std::swap(b, c);
    if (a > b)
      std::swap(a, b);
    return GroupKey{a, uint64_t(uint32_t(b)) << 32 | uint32_t(c)};
  };
  for_each_group(faces, static_cast<int64_t>(m.point.size()), threads, key, [&](const uint32_t* face, int n) {
    if (n == 2) {
      across[face[0]] = static_cast<int32_t>(face[1]);
      across[face[1]] = static_cast<int32_t>(face[0]);
    }
    for (int i = 0; n > 2 && i < n; ++i)
      across[face[i]] = crowded_face;
  });
  return across;
}

void rebuild_triangles(TetMesh& m, int threads) {
  const std::vector<int32_t> across = face_neighbors(m, threads);
  m.tri.clear();
  for (size_t face = 0; face < across.size(); ++face) {
    const int32_t region = m.region[face / 4];
    const int32_t other = across[face] < 0 ? 0 : m.region[static_cast<size_t>(across[face]) / 4];
    // Faces between two tetrahedra come twice: the lower label owns the triangle.
    if (across[face] == crowded_face || (other != 0 && region >= other))
      continue;
    Tri t = face_points(m, static_cast<int64_t>(face));
    if (!triangle_looks_out(region, other, Boundary::surface))
      std::swap(t[1], t[2]);
    m.tri.push_back(t);
  }
  m.boundary.assign(m.tri.size(), Boundary::surface);
}

} // namespace molmesh
