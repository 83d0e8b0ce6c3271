// far_box_test.cpp — walls so far away that elements there are larger than tetsmooth's parts.
#include "boxed_mesh.hpp"
#include "optimize/optimize.hpp"
#include "optimize/schedule/schedule.hpp"
#include "push_off.hpp"
#include "recovery_pass.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

TEST_CASE("in a far box elements larger than parts are improved too") {
  Hierarchy h;
  h.atom = {{{0.1, 0.2, 0.3}, 1.7}, {{1.3, 0.9, -0.4}, 1.5}, {{-0.6, 1.1, 1.2}, 1.8}};
  const BlockGrid grid = test::density_of(h, 0.5);
  const double scale = GENERATE(150., 400., 1000.);
  CAPTURE(scale);
  TetMesh mesh = test::mesh_within(grid, contour::Options::exterior, contour::BoxRequest::factor, scale);
  const optimize::Result result = optimize::improve(mesh, &grid, {});
  CHECK(result.before.above_140 > 0);
  CHECK(result.after.above_140 == 0);
  CHECK(result.after.below_25 == 0);
}

// Cubes round such points are of a lattice's cells. Those of one over the whole box were so large that all points
// were in one cube, and were more than are worked on in one.
TEST_CASE("in a far box most points off the isosurface come back in one pass") {
  Hierarchy h;
  for (int i = 0; i < 27; ++i)
    h.atom.push_back({{12. * (i % 3), 12. * (i / 3 % 3), 12. * (i / 9)}, 2});
  const BlockGrid grid = test::density_of(h, 1);
  TetMesh mesh = test::mesh_within(grid, contour::Options::both, contour::BoxRequest::factor, 60);
  optimize::improve(mesh, &grid, {});
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const Isosurface surface(grid, 1);
  const int pushed = test::push_off(m, surface);
  REQUIRE(pushed > 64);
  optimize::Schedule schedule(m, &surface, 32 * surface.spacing(), 1);
  const float worst = schedule.worst();
  schedule.search(test::recovery(0.35));
  CHECK(schedule.worst() >= worst);
  const int64_t left = optimize::measure_fidelity(m, surface, 1).points_off;
  CAPTURE(pushed, left);
  CHECK(4 * left < pushed);
}
