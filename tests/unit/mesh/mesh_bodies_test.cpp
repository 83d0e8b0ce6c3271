// mesh_bodies_test.cpp — bodies, and the tetrahedra beside triangles, against flood filling and search.
#include "mesh/mesh_bodies.hpp"
#include "mesh/triangle_sides.hpp"
#include "meshes.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace molmesh;

namespace {

/// Two bodies of region 1, a cavity in the larger one, outside around them.
TetMesh blocks() {
  return testing::cubes(
      7,
      [](Vec3i c) {
        if (c.x >= 1 && c.x <= 3 && c.y >= 1 && c.y <= 3 && c.z >= 1 && c.z <= 3)
          return c.x == 2 && c.y == 2 && c.z == 2 ? 3 : 1;
        return c.x == 5 && c.y == 5 && c.z == 5 ? 1 : 2;
      },
      0.5);
}

} // namespace

TEST_CASE("bodies are the connected parts of regions, the largest of each region first") {
  const TetMesh m = blocks();
  const MeshBodies b = find_bodies(m, face_neighbors(m, 2));
  REQUIRE(b.body.size() == 4);
  const double cube = 0.125;
  const int32_t region[] = {1, 1, 2, 3};
  const double cubes[] = {26, 1, 343 - 28, 1}, faces[] = {54 + 6, 6, 6 * 49 + 54 + 6, 6};
  for (size_t i = 0; i < 4; ++i) {
    CHECK(b.body[i].region == region[i]);
    CHECK(b.body[i].volume == Approx(cubes[i] * cube));
    CHECK(b.body[i].area == Approx(faces[i] * 0.25));
    CHECK(b.body[i].tets == int64_t(6 * cubes[i]));
    CHECK(std::count(b.of.begin(), b.of.end(), int32_t(i)) == b.body[i].tets);
  }
  CHECK(norm(b.body[0].centre - Vec3d{1.25, 1.25, 1.25}) < 1e-12);
  CHECK(norm(b.body[1].low - Vec3d{2.5, 2.5, 2.5}) < 1e-12);
  CHECK(norm(b.body[1].high - Vec3d{3, 3, 3}) < 1e-12);

  // Flood filling: what three common points connect has one number, and nothing else has.
  std::vector<int32_t> seen(m.tet.size(), -1);
  int32_t parts = 0;
  for (size_t s = 0; s < m.tet.size(); ++s) {
    if (seen[s] >= 0)
      continue;
    std::vector<size_t> open{s};
    seen[s] = parts;
    while (!open.empty()) {
      const size_t t = open.back();
      open.pop_back();
      const std::set<int32_t> own(m.tet[t].begin(), m.tet[t].end());
      for (size_t u = 0; u < m.tet.size(); ++u)
        if (seen[u] < 0 && m.region[u] == m.region[t] &&
            std::count_if(m.tet[u].begin(), m.tet[u].end(), [&](int32_t v) { return own.count(v) > 0; }) == 3) {
          seen[u] = parts;
          open.push_back(u);
        }
    }
    ++parts;
  }
  CHECK(parts == 4);
  std::set<std::pair<int32_t, int32_t>> pairs;
  for (size_t t = 0; t < m.tet.size(); ++t)
    pairs.insert({seen[t], b.of[t]});
  CHECK(pairs.size() == 4);
}

TEST_CASE("the faces beside a triangle are those on its three points") {
  TetMesh m = blocks();
  m.tri.push_back({0, 1, 2}); // no face
  m.boundary.push_back(1);
  const TriangleSides one = triangle_sides(m, 1), three = triangle_sides(m, 3);
  CHECK(one.face == three.face);
  CHECK(std::equal(one.across.begin(), one.across.end(), three.across.begin()));
  const LargeArray<int32_t> across = face_neighbors(m, 1);
  CHECK(std::equal(one.across.begin(), one.across.end(), across.begin(), across.end()));
  for (size_t i = 0; i < m.tri.size(); i += 7) {
    std::vector<int32_t> beside;
    const std::set<int32_t> own(m.tri[i].begin(), m.tri[i].end());
    for (int64_t f = 0; f < int64_t(4 * m.tet.size()); ++f) {
      const Tri t = face_points(m, f);
      if (std::set<int32_t>(t.begin(), t.end()) == own)
        beside.push_back(int32_t(f));
    }
    beside.resize(2, -1);
    CHECK(one.face[i] == std::array<int32_t, 2>{beside[0], beside[1]});
  }
  CHECK(one.face.back() == std::array<int32_t, 2>{-1, -1});
}
