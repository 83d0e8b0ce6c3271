// trace_test.cpp — where a wall cuts the surface, the curve between them lies on the isosurface and in the wall,
// and the elements at it are as good as any.
#include "cut_clusters.hpp"
#include "optimize/optimize.hpp"
#include "push_off.hpp"
#include "recovery_pass.hpp"
#include <catch2/catch.hpp>
#include <map>
#include <set>

using namespace molmesh;
using namespace molmesh::test;

namespace {

/// The boundaries of each vertex's triangles.
std::map<int32_t, std::set<int32_t>> boundaries(const TetMesh& mesh) {
  std::map<int32_t, std::set<int32_t>> of;
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    for (const int32_t v : mesh.tri[t])
      of[v].insert(mesh.boundary[t]);
  return of;
}

bool on_trace(const std::set<int32_t>& boundary) {
  return boundary.size() == 2 && boundary.count(surface) > 0;
}

} // namespace

TEST_CASE("vertices of the surface and one wall are its trace") {
  const auto meshed = GENERATE(contour::Options::interior, contour::Options::exterior, contour::Options::both);
  for (uint32_t seed = 1; seed <= 4; ++seed) {
    const TetMesh mesh = cut(cluster(seed, 1), meshed, 0.6);
    const optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
    CAPTURE(int(meshed), seed);
    int traces = 0, others = 0;
    for (const auto& [v, boundary] : boundaries(mesh)) {
      const optimize::Vertex& x = m.vertex[v];
      if (x.kind != optimize::Kind::trace) {
        others += on_trace(boundary);
        continue;
      }
      ++traces;
      CHECK(on_trace(boundary));
      CHECK(m.labels[x.label].name == surface);
      CHECK(mesh.point[v][x.axis()] == (x.axis() == 0 ? 0.6 : -0.6));
    }
    CHECK(traces > 20);
    CHECK(others == 0);
  }
}

TEST_CASE("the trace of a surface on a wall lies on the isosurface and in the wall, between good elements",
          "[slow]") {
  const auto meshed = GENERATE(contour::Options::interior, contour::Options::exterior, contour::Options::both);
  int traces = 0, off = 0;
  for (uint32_t seed = 1; seed <= 4; ++seed) {
    const BlockGrid grid = cluster(seed, 0.5);
    const Isosurface isosurface(grid, 1);
    for (const double at : {-0.9, 0.6, 1.7}) {
      TetMesh mesh = cut(grid, meshed, at);
      CAPTURE(int(meshed), seed, at);
      const Validity before = checked(mesh);
      const optimize::Result result = optimize::improve(mesh, &grid, {});
      const Validity after = checked(mesh);
      CHECK(after.surface.components == before.surface.components);
      CHECK(after.surface.euler == before.surface.euler);
      CHECK(result.after.min >= 25);
      CHECK(result.after.max <= 140);
      for (const auto& [v, boundary] : boundaries(mesh)) {
        const Vec3d p = mesh.point[v];
        CHECK((boundary.count(box_x1) == 0 || p.x == at));
        CHECK((boundary.count(box_y0) == 0 || p.y == -at));
        if (!on_trace(boundary))
          continue;
        double distance;
        Vec3d normal;
        ++traces;
        off += !isosurface.probe(p, distance, normal) || std::abs(distance) > 0.02 * isosurface.spacing();
      }
    }
  }
  CHECK(traces > 1000);
  CAPTURE(traces, off);
  CHECK(1000 * off < traces); // where the isosurface grazes the wall
}

TEST_CASE("points of a trace that were pushed off come back, within their wall") {
  const BlockGrid grid = cluster(1, 0.5);
  const Isosurface isosurface(grid, 1);
  TetMesh mesh = cut(grid, contour::Options::both, 0.6);
  optimize::improve(mesh, &grid, {});
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const optimize::Fidelity before = optimize::measure_fidelity(m, isosurface, 1);
  const int pushed = push_off(m, isosurface, optimize::Kind::trace);
  REQUIRE(pushed > 2);
  for (const optimize::Element& e : m.element)
    REQUIRE((!e.alive() || m.quality(e.v) > 0));
  REQUIRE(optimize::measure_fidelity(m, isosurface, 1).points_off_wall > before.points_off_wall);
  optimize::Schedule schedule(m, &isosurface, 32 * isosurface.spacing(), 1);
  const float worst = schedule.worst();
  for (int k = 0; k < 4; ++k)
    schedule.search(recovery(0.5));
  CHECK(optimize::measure_fidelity(m, isosurface, 1).points_off <= before.points_off);
  CHECK(schedule.worst() >= worst);
  for (size_t v = 0; v < m.point.size(); ++v)
    if (const optimize::Vertex& x = m.vertex[v]; m.incident[v] >= 0 && x.kind == optimize::Kind::trace)
      CHECK(m.point[v][x.axis()] == (x.axis() == 0 ? 0.6 : -0.6));
}
