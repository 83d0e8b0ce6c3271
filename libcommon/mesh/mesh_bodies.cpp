// mesh_bodies.cpp — joins tetrahedra across faces, in their order, so that sums are always the same.
#include "mesh/mesh_bodies.hpp"
#include "mesh/disjoint_sets.hpp"
#include <algorithm>
#include <numeric>

namespace molmesh {

MeshBodies find_bodies(const TetMesh& m, const LargeArray<int32_t>& across) {
  const auto tets = static_cast<int64_t>(m.tet.size());
  DisjointSets sets(m.tet.size());
  for (int64_t f = 0; f < 4 * tets; ++f)
    if (const int32_t other = across[f]; other / 4 > f / 4 && m.region[other / 4] == m.region[f / 4])
      sets.join(static_cast<int32_t>(f / 4), other / 4);

  MeshBodies b;
  b.of.resize(m.tet.size());
  std::vector<Vec3d> moment;
  for (int64_t t = 0; t < tets; ++t) {
    const int32_t first = sets.first(static_cast<int32_t>(t));
    if (first == t) {
      b.of[t] = static_cast<int32_t>(b.body.size());
      b.body.push_back({m.region[t], 0, 0, 0, {}, m.point[m.tet[t][0]], m.point[m.tet[t][0]]});
      moment.push_back({});
    } else
      b.of[t] = b.of[first];
    MeshBody& body = b.body[b.of[t]];
    const auto p = [&](size_t i) { return m.point[m.tet[t][i]]; };
    const double volume = tet_volume(p(0), p(1), p(2), p(3));
    ++body.tets;
    body.volume += volume;
    moment[b.of[t]] += volume * cell_centroid(m, static_cast<size_t>(t));
    for (size_t i = 0; i < 4; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        body.low[axis] = std::min(body.low[axis], p(i)[axis]);
        body.high[axis] = std::max(body.high[axis], p(i)[axis]);
      }
    for (int64_t f = 4 * t; f < 4 * t + 4; ++f)
      if (region_across(m, across, f) != m.region[t]) {
        const Tri tri = face_points(m, f);
        body.area += tri_area(m.point[tri[0]], m.point[tri[1]], m.point[tri[2]]);
      }
  }
  for (size_t i = 0; i < b.body.size(); ++i)
    b.body[i].centre =
        b.body[i].volume != 0 ? moment[i] / b.body[i].volume : 0.5 * (b.body[i].low + b.body[i].high);

  std::vector<int32_t> order(b.body.size()), place(b.body.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int32_t x, int32_t y) {
    const MeshBody &p = b.body[x], &q = b.body[y];
    return p.region != q.region ? p.region < q.region : p.volume > q.volume;
  });
  std::vector<MeshBody> sorted;
  for (size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<int32_t>(i);
    sorted.push_back(b.body[order[i]]);
  }
  b.body = std::move(sorted);
  for (int32_t& of : b.of)
    of = place[of];
  return b;
}

std::array<Vec3d, 2> box_of(const MeshBodies& bodies, const std::vector<int32_t>& region) {
  std::array<Vec3d, 2> box{Vec3d{1e300, 1e300, 1e300}, Vec3d{-1e300, -1e300, -1e300}};
  for (const MeshBody& b : bodies.body)
    for (int axis = 0; axis < 3 && std::count(region.begin(), region.end(), b.region) > 0; ++axis) {
      box[0][axis] = std::min(box[0][axis], b.low[axis]);
      box[1][axis] = std::max(box[1][axis], b.high[axis]);
    }
  return box;
}

} // namespace molmesh
