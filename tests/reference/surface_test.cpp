// surface_test.cpp — volumes, areas, topology and self-intersection by CGAL and TetGen beside our own.
#include "mesh/surface_crossings.hpp"
#include "mesh/validity.hpp"
#include "oracles.hpp"
#include "unit/mesh/meshes.hpp"
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;
using namespace molmesh::testing;

namespace {

/// Cubes of a body with a cavity and a handle, points of the mesh moved at random, but not so far that a
/// tetrahedron turns.
TetMesh displaced_body() {
  TetMesh m = cubes(11, [](Vec3i c) -> int32_t {
    if (c == Vec3i{4, 4, 4})
      return Region::cavity;
    const bool ball = norm2(to_double(c) - Vec3d{4, 4, 4}) <= 9;
    const bool handle = c.y == 4 && c.z >= 3 && c.z <= 5 && c.x >= 6 && c.x <= 9 && !(c.x <= 8 && c.z == 4);
    return ball || handle ? Region::molecule : Region::outside;
  });
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> u(-0.12, 0.12);
  for (Vec3d& p : m.point)
    for (int k = 0; k < 3; ++k)
      if (p[k] != 0 && p[k] != 11)
        p[k] += u(random);
  return m;
}

std::vector<Tri> region_boundary(const TetMesh& m, int32_t region) {
  std::vector<Tri> tri;
  const LargeArray<int32_t> across = face_neighbors(m, 1);
  for (size_t f = 0; f < across.size(); ++f)
    if (m.region[f / 4] == region && (across[f] < 0 || m.region[static_cast<size_t>(across[f]) / 4] != region))
      tri.push_back(face_points(m, static_cast<int64_t>(f)));
  return tri;
}

} // namespace

TEST_CASE("CGAL finds the same surfaces of regions, closed and without self-intersection") {
  const TetMesh m = displaced_body();
  const Validity v = check_validity(m, 1);
  REQUIRE(v.valid());
  CHECK(v.region[0].boundary.euler == 2); // a ring has 0, the cavity 2
  for (const RegionSummary& r : v.region) {
    const reference::CgalSurface s = reference::cgal_surface(m.point, region_boundary(m, r.region));
    CHECK(s.manifold);
    CHECK(s.closed);
    CHECK(s.crossings == 0);
    CHECK(s.bounds_volume);
    CHECK(s.components == r.boundary.components);
    CHECK(s.euler == r.boundary.euler);
    CHECK(s.area == Approx(r.boundary.area).epsilon(1e-12));
    CHECK(s.volume == Approx(r.volume).epsilon(1e-12));
  }
}

TEST_CASE("CGAL refuses the surfaces with crowded_edge or pinched_point, and sees what we cannot") {
  const auto diagonal = [](Vec3i second) {
    return cubes(4, [second](Vec3i c) -> int32_t { return c == Vec3i{1, 1, 1} || c == second ? 1 : 2; });
  };
  for (Vec3i second : {Vec3i{2, 2, 1}, Vec3i{2, 2, 2}}) {
    const TetMesh m = diagonal(second);
    CHECK_FALSE(check_validity(m, 1).valid());
    const reference::CgalSurface s = reference::cgal_surface(m.point, region_boundary(m, 1));
    CHECK((!s.manifold || s.crossings > 0 || s.components == 2)); // CGAL takes cubes apart that share a corner
  }
  // Two cubes apart, one moved into the other: each is fine by itself, and tetrahedra of one mesh do not show it.
  TetMesh apart = extract(diagonal({3, 3, 3}), [](int32_t r) { return r == 1; });
  REQUIRE(check_validity(apart, 1).valid());
  CHECK(reference::cgal_surface(apart.point, apart.tri).crossings == 0);
  CHECK(find_crossings(apart.point, apart.tri, 1).pairs == 0);
  for (Vec3d& p : apart.point)
    if (p.x >= 2.5)
      p += Vec3d{-1.6, -1.6, -1.6};
  const int64_t crossings = reference::cgal_surface(apart.point, apart.tri).crossings;
  CHECK(crossings > 0);
  CHECK(find_crossings(apart.point, apart.tri, 1).pairs == crossings);
}

TEST_CASE("TetGen fills our surface with the same volume, and its mesh is valid by our rules") {
  const TetMesh m = displaced_body();
  const Validity v = check_validity(m, 1);
  TetMesh fill = reference::tetgen_fill(m.point, region_boundary(m, Region::molecule), {{4.5, 4.5, 4.5}});
  rebuild_triangles(fill);
  const Validity filled = check_validity(fill, 2);
  std::string faults;
  for (const Fault& f : filled.faults)
    faults += f.rule + ' ' + std::to_string(f.count) + ' ' + f.example + '\n';
  INFO(faults);
  REQUIRE(filled.valid());
  CHECK(filled.volume == Approx(v.region[0].volume).epsilon(1e-12));
  CHECK(filled.region[0].boundary.area == Approx(v.region[0].boundary.area).epsilon(1e-12));
  CHECK(filled.region[0].boundary.triangles == v.region[0].boundary.triangles);
  CHECK(filled.region[0].boundary.euler == v.region[0].boundary.euler);
}

TEST_CASE("as many pairs of triangles cross as CGAL counts") {
  std::mt19937_64 random(31);
  int64_t crossed = 0, on_lattice = 0;
  for (int n = 0; n < 60; ++n) {
    TetMesh m = extract(displaced_body(), [](int32_t r) { return r == Region::molecule; });
    // Few points far, or all by little; on a lattice, so that touching and coplanar triangles are common.
    std::uniform_real_distribution<double> u(-1, 1);
    const bool lattice = n % 3 == 0;
    const double step = lattice ? 0.125 : 1e-6;
    for (Vec3d& p : m.point)
      if (n % 2 == 0 || random() % 10 == 0)
        for (int k = 0; k < 3; ++k)
          p[k] = step * std::round((p[k] + (n % 2 ? 1.0 : 0.3) * u(random)) / step);
    bool degenerate = false; // CGAL's answer is not defined for these
    for (const Tri& t : m.tri) {
      const auto p = [&](size_t i) { return m.point[t[i]]; };
      degenerate |= tri_normal(p(0), p(1), p(2)) == Vec3d{0, 0, 0};
    }
    if (degenerate)
      continue;
    const int64_t expected = reference::cgal_surface(m.point, m.tri).crossings;
    crossed += expected;
    on_lattice += lattice && expected > 0;
    const Crossings found = find_crossings(m.point, m.tri, 1);
    CHECK(found.pairs == expected);
    CHECK(find_crossings(m.point, m.tri, 5).first == found.first);
  }
  CHECK(crossed > 100);
  CHECK(on_lattice > 3);
}
