// neck_test.cpp — a passage far narrower than the grid is found, and the surface follows it down.
#include "lattice_mesh.hpp"
#include "optimize/optimize.hpp"
#include "optimize/schedule/schedule.hpp"
#include "recovery_pass.hpp"
#include "surface_shape.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

constexpr double h = 0.5;
constexpr int n = 20;
const Vec3d middle{5.004, 5.003, 4.998}; // a grid point but for a little

/// A ball of 4.6 h with a passage through it of 0.6 h, and of `narrow` at its middle: two cones as long as `reach`.
Field pierced_ball(double narrow, double reach, Vec3d way) {
  return [=](Vec3d p) {
    const Vec3d x = p - middle;
    const double along = std::abs(dot(x, way)), across = norm(x - dot(x, way) * way), wide = 0.6 * h;
    const double passage = along > reach ? wide : narrow + (wide - narrow) * along / reach;
    return std::exp(0.5 * std::min(4.6 * h - norm(x), across - passage));
  };
}

/// The same, but on one side the passage ends `depth` from its middle.
Field dead_end(double narrow, double reach, double depth, Vec3d way) {
  const Field through = pierced_ball(narrow, reach, way);
  return [=](Vec3d p) {
    const Vec3d x = p - middle;
    return std::max(through(p), std::exp(0.5 * std::min(4.6 * h - norm(x), -dot(x, way) - depth)));
  };
}

constexpr double endless = 100;

} // namespace

TEST_CASE("a neck is found where it is, and none where the passage is wide") {
  const int axis = GENERATE(0, 1, 2);
  Vec3d way, across;
  way[axis] = across[(axis + 1) % 3] = 1;
  const Isosurface narrow(lattice_grid(pierced_ball(0.05 * h, 2 * h, way), {0, 0, 0}, h, n), 1),
      wide(lattice_grid(pierced_ball(0.5 * h, 2 * h, way), {0, 0, 0}, h, n), 1);
  const Vec3d off = middle + 0.7 * h * way + 0.5 * h * across; // in the ball, beside the passage
  Neck neck;
  REQUIRE(narrow.neck(off, neck));
  CHECK(norm(neck.at - middle) < 0.3 * h);
  CHECK(std::abs(dot(neck.along, way)) > 0.8);
  CHECK(norm(neck.along) == Approx(1));
  CHECK_FALSE(wide.neck(off, neck));
}

TEST_CASE("the surface follows a passage of hundredths of a spacing", "[slow]") {
  struct Case {
    int keep;
    double narrow, reach, depth = endless;
  };
  // Behind a neck near its end the surface turns back to where the neck's shell would be.
  const Case c = GENERATE(Case{0, 0.01, 2}, Case{0, 0.02, 2}, Case{0, 0.03, 2.5}, Case{2, 0.01, 1.5},
                          Case{2, 0.03, 2.5}, Case{1, 0.01, 2.5}, Case{0, 0.01, 2, 1.5}, Case{0, 0.03, 2, 1.8});
  CAPTURE(c.keep, c.narrow, c.reach, c.depth);
  const Vec3d way{0, 0, 1};
  const Field tube = dead_end(0.6 * h, c.reach * h, c.depth * h, way),
              field = dead_end(c.narrow * h, c.reach * h, c.depth * h, way);
  const BlockGrid grid = lattice_grid(tube, {0, 0, 0}, h, n);
  TetMesh mesh = lattice_mesh(tube, {0, 0, 0}, h, n, c.keep);
  optimize::improve(mesh, &grid, {}); // with the passage as wide at its middle as elsewhere
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const Isosurface surface(lattice_grid(field, {0, 0, 0}, h, n), 1);
  const int64_t shape = surface_shape(mesh).euler();
  REQUIRE(optimize::measure_fidelity(m, surface, 1).points_off > 3);
  optimize::Schedule schedule(m, &surface, 32 * h, 1);
  schedule.watch_crossings(optimize::Schedule::everywhere);
  optimize::Counts counts;
  for (const optimize::Moves moves : {optimize::Moves::bold, optimize::Moves::necks})
    counts += schedule.search(recovery(1, moves));
  CHECK(counts.cavity_shrinks > 0);
  float worst = 2;
  for (const optimize::Element& e : m.element)
    worst = e.alive() ? std::min(worst, e.q) : worst;
  CHECK(schedule.worst() == worst); // it looks again only where something has changed
  CHECK(optimize::Schedule(m, &surface, 32 * h, 1).worst() == worst);
  CHECK(optimize::measure_fidelity(m, surface, 1).points_off == 0);
  CHECK(schedule.below(static_cast<float>(angle_quality(25))) == 0);
  const TetMesh now = optimize::extract(m);
  CHECK(surface_shape(now).euler() == shape);
  CHECK_NOTHROW(optimize::build(now, 180, 1));
}

TEST_CASE("a surface that touches itself is left alone where it does", "[slow]") {
  const Field tube = pierced_ball(0.6 * h, 2 * h, {0.6, 0, 0.8}),
              field = pierced_ball(0.05 * h, 2 * h, {0.6, 0, 0.8});
  const BlockGrid grid = lattice_grid(tube, {0, 0, 0}, h, n);
  TetMesh mesh =
      lattice_mesh(tube, {0, 0, 0}, h, n, 2); // ambiguous cells: points that two pieces of the surface share
  optimize::improve(mesh, &grid, {});
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const Isosurface surface(lattice_grid(field, {0, 0, 0}, h, n), 1);
  optimize::Schedule schedule(m, &surface, 32 * h, 1);
  const std::vector<Vec3d> before = m.point;
  std::vector<size_t> fixed;
  for (size_t v = 0; v < m.vertex.size(); ++v)
    if (m.vertex[v].kind == optimize::Kind::fixed)
      fixed.push_back(v);
  REQUIRE(fixed.size() > 8); // not the box's corners alone
  for (const optimize::Moves moves : {optimize::Moves::bold, optimize::Moves::necks, optimize::Moves::necks})
    schedule.search(recovery(1, moves));
  CHECK_NOTHROW(optimize::build(optimize::extract(m), 180, 1));
  for (const size_t v : fixed)
    CHECK(m.point[v] == before[v]);
}
