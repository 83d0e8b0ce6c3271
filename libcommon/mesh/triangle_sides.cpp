// triangle_sides.cpp — reads both off the groups of faces on the same points.
#include "mesh/triangle_sides.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/face_groups.hpp"

namespace molmesh {

TriangleSides triangle_sides(const TetMesh& m, int threads) {
  const auto faces = static_cast<int64_t>(4 * m.tet.size());
  TriangleSides s{LargeArray<int32_t>(static_cast<size_t>(faces), no_face),
                  std::vector<std::array<int32_t, 2>>(m.tri.size(), {no_face, no_face})};
  for_each_face(m.tet, m.tri, static_cast<int64_t>(m.point.size()), threads,
                [&](const uint32_t* face, int n, bool) {
                  int of_tets = 0;
                  while (of_tets < n && face[of_tets] < faces)
                    ++of_tets;
                  if (of_tets == 2) {
                    s.across[face[0]] = static_cast<int32_t>(face[1]);
                    s.across[face[1]] = static_cast<int32_t>(face[0]);
                  }
                  for (int i = 0; of_tets > 2 && i < of_tets; ++i)
                    s.across[face[i]] = crowded_face;
                  for (int i = of_tets; i < n; ++i)
                    for (int k = 0; k < std::min(of_tets, 2); ++k)
                      s.face[face[i] - faces][k] = static_cast<int32_t>(face[k]);
                });
  return s;
}

} // namespace molmesh
