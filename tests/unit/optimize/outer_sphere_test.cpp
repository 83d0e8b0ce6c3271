// outer_sphere_test.cpp — the outer sphere of a mesh: its points slide on it, its triangles stay flat on it.
#include "boxed_mesh.hpp"
#include "optimize/acceptance/sag.hpp"
#include "optimize/optimize.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;
namespace {

double largest_sag_of(const TetMesh& m) {
  double most = 0;
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] == Boundary::outer_sphere)
      most = std::max(most,
                      optimize::sag(*m.sphere, m.point[m.tri[t][0]], m.point[m.tri[t][1]], m.point[m.tri[t][2]]));
  return most;
}

} // namespace

TEST_CASE("points of the outer sphere stay on it while elements get good", "[slow]") {
  Hierarchy h;
  h.atom = {{{0.1, 0.2, 0.3}, 1.7}, {{1.3, 0.9, -0.4}, 1.5}, {{-0.6, 1.1, 1.2}, 1.8}};
  const BlockGrid grid = test::density_of(h, 0.5);
  const double scale = GENERATE(2., 7., 100.);
  for (const auto meshed : {contour::Options::exterior, contour::Options::both})
    for (const bool with_density : {true, false}) {
      CAPTURE(scale, int(meshed), with_density);
      TetMesh mesh = test::mesh_within(grid, meshed, contour::BoxRequest::sphere_factor, scale);
      const Sphere sphere = *mesh.sphere;
      optimize::Options options;
      options.sharp = 180;
      const optimize::Result result = optimize::improve(mesh, with_density ? &grid : nullptr, options);
      test::checked(mesh); // the rule sphere_point among others
      REQUIRE(mesh.sphere);
      CHECK(mesh.sphere->radius == sphere.radius);
      CHECK(largest_sag_of(mesh) <= optimize::most_sag);
      if (!with_density)
        continue;
      CHECK(result.after.below_25 == 0);
      CHECK(result.after.above_140 == 0);
      CHECK(result.fidelity.points_off == 0);
    }
}

TEST_CASE("what lies on the sphere is round, and of another label or off it is not") {
  Hierarchy h;
  h.atom = {{{0, 0, 0}, 3}};
  TetMesh mesh = test::mesh_within(test::density_of(h, 0.5), contour::Options::exterior,
                                   contour::BoxRequest::sphere_factor, 2);
  std::vector<uint8_t> on(mesh.point.size(), 0);
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    for (const int32_t v : mesh.tri[t])
      on[v] = mesh.boundary[t] == Boundary::outer_sphere;
  const optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  for (size_t v = 0; v < on.size(); ++v)
    REQUIRE((m.vertex[v].kind == optimize::Kind::round) == (on[v] != 0));
  mesh.sphere->radius *= 1.01;
  const optimize::DynamicMesh off = optimize::build(mesh, 180, 1);
  for (size_t v = 0; v < on.size(); ++v)
    REQUIRE(off.vertex[v].kind != optimize::Kind::round);
}

TEST_CASE(
    "a triangle sags by the depth of its plane below the sphere, and one that is turned by more than its radius") {
  const Sphere s{{1, 2, 3}, 5};
  const auto at = [&](Vec3d d) { return s.nearest(s.center + d); };
  const Vec3d a = at({1, 0, 0}), b = at({0, 1, 0}), c = at({0, 0, 1});
  // The octant's plane is at R/√3, its edges are R·√2.
  CHECK(optimize::sag(s, a, b, c) == Approx((1 - 1 / std::sqrt(3.)) / std::sqrt(2.)));
  CHECK(optimize::sag(s, a, c, b) == Approx((1 + 1 / std::sqrt(3.)) / std::sqrt(2.)));
}
