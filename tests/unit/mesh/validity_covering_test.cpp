// validity_covering_test.cpp — meshes whose tetrahedra match face to face and are positive, and that are none all
// the same.
#include "mesh/validity.hpp"
#include "meshes.hpp"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::testing;

namespace {

std::string rules(const TetMesh& m) {
  std::string s;
  for (const int threads : {1, 3}) {
    std::string now;
    for (const Fault& f : check_validity(m, threads).faults)
      now += f.rule + ' ' + std::to_string(f.count) + ' ';
    CHECK((threads == 1 || now == s));
    s = now;
  }
  return s;
}

int32_t all_inside(Vec3i) {
  return Region::molecule;
}

/// A block of cubes in which a tetrahedron is replaced by three round a point on one of its faces, or that far off
/// it in its height: the neighbour's face stays whole.
TetMesh with_hanging_node(double off) {
  TetMesh m = cubes(3, all_inside);
  const LargeArray<int32_t> across = face_neighbors(m, 1);
  const auto is_inner = [&](int32_t v) {
    const Vec3d p = m.point[v];
    return std::min({p.x, p.y, p.z}) > 0 && std::max({p.x, p.y, p.z}) < 3;
  };
  int64_t face = 0;
  for (const auto within =
           [&](int64_t f) {
             const Tri t = face_points(m, f);
             return across[f] >= 0 && is_inner(t[0]) && is_inner(t[1]) && is_inner(t[2]);
           };
       !within(face);)
    ++face;
  const Tri t = face_points(m, face);
  const auto tet = static_cast<size_t>(face / 4);
  const int32_t apex = m.tet[tet][face % 4], node = static_cast<int32_t>(m.point.size());
  const auto at = [&](int32_t v) { return m.point[v]; };
  const Vec3d on = 0.25 * at(t[0]) + 0.25 * at(t[1]) + 0.5 * at(t[2]);
  m.point.push_back(on + off * (at(apex) - on));
  for (size_t i = 0; i < 3; ++i) {
    const Tet part{t[(i + 1) % 3], t[i], node, apex};
    if (i == 0)
      m.tet[tet] = part;
    else
      m.tet.push_back(part), m.region.push_back(Region::molecule);
  }
  rebuild_triangles(m);
  return m;
}

TetMesh joined(TetMesh a, const TetMesh& b) {
  const auto first = static_cast<int32_t>(a.point.size());
  a.point.insert(a.point.end(), b.point.begin(), b.point.end());
  for (Tet t : b.tet) {
    for (int32_t& v : t)
      v += first;
    a.tet.push_back(t);
  }
  a.region.insert(a.region.end(), b.region.begin(), b.region.end());
  rebuild_triangles(a);
  return a;
}

} // namespace

TEST_CASE("a hanging node is found, on its face and beyond it, and a void is none") {
  CHECK(rules(with_hanging_node(0)) == "overlap 1 ");
  CHECK(rules(with_hanging_node(1e-7)) == "overlap 1 "); // as coordinates of single precision have it
  CHECK(rules(with_hanging_node(-0.1)) == "overlap 1 ");
  CHECK(rules(with_hanging_node(0.1)).empty());
}

TEST_CASE("bodies may lie beside each other and in each other's cavities, but not within each other") {
  const TetMesh block = cubes(2, all_inside, 1, {0.1, 0.2, 0.3}),
                small = cubes(1, all_inside, 0.25, {1.013, 1.021, 1.034});
  CHECK(rules(joined(block, cubes(2, all_inside, 1, {5, 0, 0}))).empty());
  CHECK(rules(joined(block, small)) == "overlap 1 ");
  CHECK(rules(joined(joined(block, small), cubes(1, all_inside, 0.0625, {1.1, 1.1, 1.1}))) == "overlap 2 ");
  const auto shell = [](Vec3i c) -> int32_t { return c == Vec3i{1, 1, 1} ? Region::outside : Region::molecule; };
  TetMesh hollow = extract(cubes(3, shell), [](int32_t r) { return r == Region::molecule; });
  CHECK(rules(joined(hollow, cubes(1, all_inside, 0.5, {1.25, 1.25, 1.25}))).empty());
}
