// walls_test.cpp — a surface that walls cut stays in the box, and none of its triangles comes to lie in a wall.
#include "cuda/optimize/geometric_flow.hpp"
#include "cuda/par/host.hpp"
#include "cut_clusters.hpp"
#include "optimize/optimize.hpp"
#include "optimize/schedule/schedule.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

TEST_CASE("improvement keeps a cut surface in the box and out of its walls", "[slow]") {
  const auto meshed = GENERATE(contour::Options::interior, contour::Options::exterior);
  for (uint32_t seed = 1; seed <= 4; ++seed) {
    const BlockGrid grid = cluster(seed, 1);
    for (const double at : {-2.3, -0.9, 0.6, 1.7, 3.2, 4.4}) {
      TetMesh mesh = cut(grid, meshed, at);
      CAPTURE(int(meshed), seed, at);
      const Validity before = checked(mesh);
      optimize::improve(mesh, &grid, {});
      const Validity after = checked(mesh);
      CHECK(after.high.x == before.high.x);
      CHECK(after.low.y == before.low.y);
      CHECK(after.surface.components == before.surface.components);
      CHECK(after.surface.euler == before.surface.euler);
    }
  }
}

// A ball that the wall x = 1 cuts in half, and one whose tip is about to come through.
BlockGrid tip(double beyond) {
  return cube_grid(8, 1, [=](Vec3d x) {
    return std::exp(-0.5 * (norm2(x - Vec3d{1, -4, 0}) - 6.25)) +
           std::exp(-0.5 * (norm2(x - Vec3d{beyond - 1.5, 3.5, 0.5}) - 6.25));
  });
}

TEST_CASE("a tip of the isosurface beyond a wall takes no point of the surface with it", "[slow]") {
  const auto meshed = GENERATE(contour::Options::interior, contour::Options::exterior);
  for (int k = -2; k <= 10; ++k) {
    const BlockGrid grid = tip(0.03 * k);
    contour::Options options;
    options.meshed = meshed;
    options.box.kind = contour::BoxRequest::corners;
    options.box.lower = {-9, -9, -9};
    options.box.upper = {1, 9, 9};
    TetMesh mesh = mesh_of(grid, options);
    CAPTURE(int(meshed), k);
    checked(mesh);
    optimize::improve(mesh, &grid, {});
    CHECK(checked(mesh).high.x == 1);
  }
}

TEST_CASE("the device's flow keeps a cut surface in the box") {
  for (uint32_t seed = 1; seed <= 4; ++seed) {
    const BlockGrid grid = cluster(seed, 1);
    const Isosurface surface(grid, 1);
    for (const double at : {-2.3, -0.9, 0.6, 1.7, 3.2, 4.4}) {
      optimize::DynamicMesh m = optimize::build(cut(grid, contour::Options::interior, at), 180, 1);
      REQUIRE(m.walls.high.x == at);
      REQUIRE(m.walls.low.y == -at);
      optimize::Pass pass;
      pass.goal = static_cast<float>(angle_quality(30));
      pass.guard = {180, 1e3, 1, 0};
      cuda::HostBackend backend(1);
      CHECK(cuda::Flow<cuda::HostBackend>(backend, &surface, 1).run(m, pass, 8) > 0);
      int64_t beyond = 0;
      for (const Vec3d& p : m.point)
        beyond += p.x > at || p.y < -at;
      CHECK(beyond == 0);
    }
  }
}

TEST_CASE("the device's flow leaves surfaces that face each other to the host") {
  const BlockGrid grid = cluster(1, 1);
  const Isosurface surface(grid, 1);
  contour::Options options;
  options.meshed = contour::Options::interior;
  optimize::DynamicMesh m = optimize::build(mesh_of(grid, options), 180, 1);
  optimize::Schedule schedule(m, &surface, 100, 1);
  const optimize::DynamicMesh before = m;
  optimize::Pass pass;
  pass.goal = static_cast<float>(angle_quality(30));
  cuda::HostBackend backend(1);
  REQUIRE(cuda::Flow<cuda::HostBackend>(backend, &surface, 1).run(m, pass, 8) > 0);
  int64_t watched = 0, moved = 0, moved_watched = 0;
  for (size_t t = 0; t < m.element.size(); ++t)
    for (size_t f = 0; f < 4; ++f)
      if (m.element[t].alive() && m.element[t].n[f] < 0) {
        const auto v = optimize::outward_triangle(m.element[t].v, f);
        const bool changed =
            std::any_of(v.begin(), v.end(), [&](int32_t w) { return m.point[w] != before.point[w]; });
        watched += m.watched(v);
        moved += changed;
        moved_watched += changed && m.watched(v);
      }
  CHECK(watched > 10);
  CHECK(moved > 10);
  CHECK(moved_watched == 0);
}

TEST_CASE("walls are planes that a mesh ends at") {
  constexpr double none = 1e300;
  const optimize::DynamicMesh m = optimize::build(cut(cluster(1, 1), contour::Options::interior, 0.6), 180, 1);
  CHECK(m.walls.low == Vec3d{-none, -0.6, -none});
  CHECK(m.walls.high == Vec3d{0.6, none, none});
  const optimize::Walls& w = m.walls;
  CHECK(w.allow({0, 0, 0}, {0.45, -0.45, 7}, 0.1));
  CHECK_FALSE(w.allow({0, 0, 0}, {0.55, 0, 0}, 0.1));
  CHECK_FALSE(w.allow({0, 0, 0}, {0, -0.55, 0}, 0.1));
  CHECK(w.allow({0.55, 0, 0}, {0.55, 1, 1}, 0.1)); // as near as it was
  CHECK_FALSE(w.allow({0.55, 0, 0}, {0.56, 1, 1}, 0.1));
  CHECK_FALSE(w.clear({0.55, 0, 0}, 0.1));
  CHECK(w.hold({0.6, 0, 0}, {0.6, 1, 0}, {0.6, 0, 1}));
  CHECK(w.hold({0, -0.6, 0}, {0.1, -0.6, 0}, {0, -0.6, 1}));
  CHECK_FALSE(w.hold({0.6, 0, 0}, {0.6, 1, 0}, {0.59, 0, 1}));
}
