// last_elements_test.cpp — the last elements below the goal come over it, where they are few.
#include "isosurface/isosurface.hpp"
#include "optimize/acceptance/faults.hpp"
#include "optimize/optimize.hpp"
#include "optimize/schedule/schedule.hpp"
#include "unit/optimize/cut_clusters.hpp"
#include "unit/optimize/lattice_mesh.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;
using namespace molmesh::test;

TEST_CASE("few elements below the goal are searched for, many are left alone") {
  const Vec3d middle{5.03, 5.01, 4.98};
  const Field ball = [&](Vec3d p) { return std::exp(3 - norm(p - middle)); };
  const Isosurface surface(lattice_grid(ball, {0, 0, 0}, 0.5, 20), 1);
  for (const bool many : {false, true}) {
    optimize::DynamicMesh m = optimize::build(lattice_mesh(ball, {0, 0, 0}, 0.5, 20, 1), 180, 1);
    optimize::Schedule schedule(m, &surface, 100, 1);
    optimize::Pass pass;
    pass.goal = static_cast<float>(angle_quality(15));
    pass.merges_and_splits = true;
    optimize::Strategy strategy;
    strategy.scope = optimize::Scope::elements;
    strategy.goal = pass.goal;
    strategy.part_size = 1;
    strategy.hill_climbing = 300;
    for (int round = 0; round < 4; ++round)
      schedule.run(pass);
    REQUIRE(schedule.worst() >= 0.93f * pass.goal);
    // Vertices within the ball are pressed towards a neighbour.
    int pressed = 0;
    for (size_t v = 0; v < m.point.size() && pressed < (many ? 40 : 1); ++v)
      if (m.incident[v] >= 0 && m.vertex[v].kind == optimize::Kind::interior && norm(m.point[v] - middle) < 2) {
        const optimize::Element& e = m.element[m.incident[v]];
        const int32_t to = e.v[e.v[0] == static_cast<int32_t>(v) ? 1 : 0];
        const Vec3d was = m.point[v];
        m.point[v] = was + 0.85 * (m.point[to] - was);
        bool positive = true;
        for (optimize::Element& t : m.element)
          if (t.alive() && t.find(static_cast<int32_t>(v)) >= 0)
            positive = positive && m.quality(t.v) > 0;
        if (!positive) {
          m.point[v] = was;
          continue;
        }
        for (size_t t = 0; t < m.element.size(); ++t)
          if (m.element[t].alive() && m.element[t].find(static_cast<int32_t>(v)) >= 0) {
            m.element[t].q = m.quality(m.element[t].v);
            m.dirty[t / optimize::DynamicMesh::chunk] = 1;
          }
        ++pressed;
      }
    REQUIRE(pressed > 0);
    const float fault = optimize::FaultCount::share * pass.goal;
    const int64_t below = schedule.below(fault);
    REQUIRE((many ? below > 64 : below > 0));
    const optimize::Counts counts = schedule.search(strategy);
    CHECK((many ? counts.total() == 0 : counts.total() > 0));
    CHECK((many ? schedule.below(fault) == below : schedule.below(fault) == 0));
  }
}

TEST_CASE("Effort fast keeps its promise where a wall cuts features of a spacing") {
  for (const uint32_t seed : {10U, 29U, 34U, 106U}) { // its six rounds leave 9 to 15 degrees
    const BlockGrid grid = cluster(seed, 1.3);
    TetMesh mesh = cut(grid, contour::Options::both, 2.3);
    optimize::Options options;
    options.effort = optimize::Effort::fast;
    const optimize::Result r = optimize::improve(mesh, &grid, options);
    CAPTURE(seed);
    CHECK(r.after.min >= 15);
    CHECK(r.after.max <= 155);
    Validity v = check_validity(mesh, 1);
    add_crossings(v, mesh, 1);
    CHECK(v.valid());
  }
}
