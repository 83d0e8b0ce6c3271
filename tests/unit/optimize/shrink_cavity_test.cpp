// shrink_cavity_test.cpp — a hole smaller than the grid comes to its size and place; nothing around it is touched.
#include "lattice_mesh.hpp"
#include "optimize/acceptance/surface_fit.hpp"
#include "optimize/operations/operations.hpp"
#include "optimize/optimize.hpp"
#include "optimize/schedule/schedule.hpp"
#include "recovery_pass.hpp"
#include "surface_shape.hpp"
#include <catch2/catch.hpp>
#include <numeric>

using namespace molmesh;
using namespace molmesh::test;

namespace {

constexpr double h = 0.5;
constexpr int n = 20;
const Vec3d middle{5.004, 5.003, 4.998}; // a grid point but for a little
const Vec3d ball{5.1, 4.96, 5.07};

/// A ball of 5.4 h with a hole of `radius` in it.
Field ball_with_hole(double radius) {
  return
      [radius](Vec3d p) { return std::exp(0.5 * std::min(5.4 * h - norm(p - ball), norm(p - middle) - radius)); };
}

struct Case {
  BlockGrid grid;
  Isosurface surface;
  TetMesh mesh;
  explicit Case(double radius, int keep)
      : grid(lattice_grid(ball_with_hole(radius), {0, 0, 0}, h, n)), surface(grid, 1),
        mesh(lattice_mesh(ball_with_hole(radius), {0, 0, 0}, h, n, keep)) {}
};

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tet)
    sum += volume6(mesh.point[t[0]], mesh.point[t[1]], mesh.point[t[2]], mesh.point[t[3]]) / 6;
  return sum;
}

} // namespace

TEST_CASE("all points of a hole smaller than the grid come to lie on it", "[slow]") {
  const int keep = GENERATE(0, 1);
  const double radius = GENERATE(0.3, 0.1, 0.03) * h;
  Case c(radius, keep);
  const optimize::Result result = optimize::improve(c.mesh, &c.grid, {});
  CHECK(result.fidelity.points_off == 0);
  CHECK(result.after.min >= 25);
  CHECK(result.after.max <= 140);
  CHECK(surface_shape(c.mesh).euler() == 4);
  CHECK_NOTHROW(optimize::build(c.mesh, 180, 1));
}

TEST_CASE("a hole much larger than what it stands for shrinks among good elements", "[slow]") {
  const int keep = GENERATE(0, 1);
  Case large(0.6 * h, keep), small(0.02 * h, keep);
  optimize::improve(large.mesh, &large.grid, {});
  optimize::DynamicMesh m = optimize::build(large.mesh, 180, 1);
  REQUIRE(optimize::measure_fidelity(m, small.surface, 1).points_off > 3);
  optimize::Schedule schedule(m, &small.surface, 32 * h, 1);
  const double size = GENERATE(0.6, 1.);
  optimize::Counts counts;
  for (int k = 0; k < 4; ++k)
    counts += schedule.search(recovery(size));
  CHECK(optimize::measure_fidelity(m, small.surface, 1).points_off == 0);
  CHECK((counts.cavity_shrinks > 0 || keep == 0)); // with elements on both sides its points go step by step
  CHECK(schedule.below(static_cast<float>(angle_quality(25))) == 0);
  CHECK(surface_shape(optimize::extract(m)).euler() == 4);
  CHECK_NOTHROW(optimize::build(optimize::extract(m), 180, 1));
}

TEST_CASE("a part has room for the shells of a hole that has grown to several spacings", "[slow]") {
  const int keep = GENERATE(0, 1);
  Case large(1.6 * h, keep), small(0.03 * h, keep);
  optimize::improve(large.mesh, &large.grid, {});
  optimize::DynamicMesh m = optimize::build(large.mesh, 180, 1);
  const int64_t off = optimize::measure_fidelity(m, small.surface, 1).points_off;
  CAPTURE(off);
  REQUIRE(off > 3);
  optimize::Schedule schedule(m, &small.surface, 32 * h, 1);
  const optimize::Counts counts = schedule.search(recovery(1));
  CHECK(counts.cavity_shrinks > 0);
  CHECK(optimize::measure_fidelity(m, small.surface, 1).points_off == 0);
}

TEST_CASE("shells fill what they are put into, and the surface keeps its triangles") {
  const int keep = GENERATE(0, 1);
  Case c(0.05 * h, keep);
  optimize::DynamicMesh m = optimize::build(c.mesh, 180, 1);
  const size_t points = m.point.size(), elements = m.element.size(), more = 4000;
  // The hole is four times as large as what it stands for.
  optimize::PartRoom room{0, std::vector<int32_t>(more), std::vector<int32_t>(more)};
  std::iota(room.element.begin(), room.element.end(), int32_t(elements));
  std::iota(room.vertex.begin(), room.vertex.end(), int32_t(points));
  m.resize(elements + more, points + more);
  optimize::Parts parts;
  parts.owner.resize(m.point.size());
  std::vector<uint32_t> stamp(m.element.size());
  optimize::Region region(m, &c.surface, nullptr, parts, stamp, room);
  int32_t in_hole = -1;
  for (size_t v = 0; v < points; ++v)
    if (m.vertex[v].kind == optimize::Kind::surface && norm(m.point[v] - middle) < 2 * h)
      in_hole = static_cast<int32_t>(v);
  REQUIRE(in_hole >= 0);
  for (size_t v = 0; v < points; ++v)
    if (m.vertex[v].kind == optimize::Kind::surface && norm(m.point[v] - middle) < 2 * h)
      m.point[v] = middle + 4. * (m.point[v] - middle);
  const TetMesh then = optimize::extract(m);
  const SurfaceShape before = surface_shape(then);
  const double hole_before = optimize::measure_fidelity(m, c.surface, 1).volume;
  REQUIRE(optimize::off(region, in_hole) > 1);
  REQUIRE(optimize::shrink_cavity(region, in_hole, 0.5));
  CHECK(region.counts.cavity_shrinks == 1);
  CHECK(optimize::off(region, in_hole) <= 1);
  const TetMesh now = optimize::extract(m);
  const SurfaceShape after = surface_shape(now);
  CHECK(after.triangles == before.triangles);
  CHECK(after.euler() == before.euler());
  CHECK(now.tet.size() > elements);
  CHECK_NOTHROW(optimize::build(now, 180, 1)); // no element overlaps its neighbour, all are positive
  // Of both regions together the volume stays; the molecule gains what the hole loses.
  const double gained = optimize::measure_fidelity(m, c.surface, 1).volume - hole_before;
  CHECK(gained > 0);
  CHECK(volume(now) - volume(then) == Approx(keep == 0 ? 0 : gained).margin(1e-9));
  for (const int32_t v : room.vertex)
    REQUIRE(m.incident[v] < 0);
}
