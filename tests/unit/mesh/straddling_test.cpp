// straddling_test.cpp — bodies whose points lie on a sphere have its volume afterwards; what may not move stays.
#include "geom/tet_measures.hpp"
#include "mesh/straddling.hpp"
#include "unit/mesh/meshes.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;

namespace {

/// n³ cubes of the middle as a ball of radius 1, the rest round it. Points of the cubes' faces go to the sphere,
/// others as much nearer to the middle, so that shells of cubes become shells.
TetMesh ball(int n, int around) {
  TetMesh m = testing::cubes(
      n + 2 * around,
      [&](Vec3i c) {
        const auto in = [&](int i) { return i >= around && i < around + n; };
        return in(c.x) && in(c.y) && in(c.z) ? 1 : 2;
      },
      2.0 / n, -(1 + 2.0 * around / n) * Vec3d{1, 1, 1});
  for (Vec3d& p : m.point)
    if (const double shell = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}); shell > 0)
      p = shell / norm(p) * p;
  return m;
}

} // namespace

TEST_CASE("triangles whose points lie on a sphere straddle it") {
  for (const int n : {8, 16}) {
    TetMesh m = ball(n, 2);
    const double exact = 4 * 3.14159265358979 / 3, before = testing::volume(m, 1) / exact - 1,
                 both = testing::volume(m, 1) + testing::volume(m, 2);
    CHECK(before < -0.018 * (8.0 / n) * (8.0 / n));
    CHECK(straddle_surface(m) == 6 * n * n + 2);
    CHECK(std::fabs(testing::volume(m, 1) / exact - 1) < -0.05 * before);
    CHECK(testing::volume(m, 1) + testing::volume(m, 2) == Approx(both));
  }
}

TEST_CASE("a plane, walls and points on both stay") {
  TetMesh flat = testing::cubes(4, [](Vec3i c) { return c.x < 2 ? 1 : 2; });
  const std::vector<Vec3d> before = flat.point;
  straddle_surface(flat);
  for (size_t v = 0; v < before.size(); ++v)
    CHECK(norm(flat.point[v] - before[v]) < 1e-15);
  TetMesh walls = testing::cubes(4, [](Vec3i c) { return c.x < 2 && c.y < 2 ? 1 : 2; });
  straddle_surface(walls);
  int moved = 0;
  for (size_t v = 0; v < before.size(); ++v) {
    const bool wall = before[v].z == 0 || before[v].z == 4 || before[v].x == 0 || before[v].y == 0;
    const double by = norm(walls.point[v] - before[v]);
    CHECK((!wall || by == 0));
    CHECK(by <= 0.1 + 1e-12);
    moved += by > 0;
  }
  CHECK(moved > 0); // the ridge
}

TEST_CASE("no element loses more than half of its volume") {
  TetMesh m = ball(8, 2);
  for (Vec3d& p : m.point) // points outside come down to right above the triangles
    if (norm(p) > 1.1 && norm(p) < 1.3)
      p = 1.002 / norm(p) * p;
  const std::vector<Vec3d> before = m.point;
  const auto size = [&](const std::vector<Vec3d>& p, const Tet& t) {
    return tet_volume(p[t[0]], p[t[1]], p[t[2]], p[t[3]]);
  };
  const int64_t moved = straddle_surface(m);
  CHECK(moved < 6 * 8 * 8 + 2);
  for (const Tet& t : m.tet)
    if (size(before, t) > 0)
      CHECK(size(m.point, t) >= 0.5 * size(before, t) - 1e-18);
}
