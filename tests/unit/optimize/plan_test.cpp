// plan_test.cpp — a plan of the improvement grows with what makes it longer.
#include "optimize/plan.hpp"
#include "unit/mesh/meshes.hpp"
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;
using optimize::Effort;

TEST_CASE(
    "effort, thin places and threads make an improvement larger, and without rounds nothing is searched for") {
  optimize::Work work;
  work.elements = 1'000'000;
  work.triangles = 80'000;
  work.across = 2000; // as many as usual
  const optimize::Plan plan = optimize::plan(work);
  const auto changed = [&](auto change) {
    optimize::Work w = work;
    change(w);
    return optimize::plan(w);
  };
  CHECK(plan.elements == work.elements);
  CHECK(changed([](auto& w) { w.across = -1; }).seconds == Approx(plan.seconds));
  CHECK(changed([](auto& w) { w.low = 0; }).seconds < 0.7 * plan.seconds);
  CHECK(changed([](auto& w) { w.low = 250'000; }).seconds > 2 * plan.seconds);
  CHECK(changed([](auto& w) { w.across = 8000; }).seconds > 2 * plan.seconds);
  CHECK(changed([](auto& w) { w.effort = Effort::fast; }).seconds < 0.6 * plan.seconds);
  CHECK(changed([](auto& w) { w.effort = Effort::best; }).seconds > 2 * plan.seconds);
  CHECK(changed([](auto& w) { w.threads = 9; }).memory == plan.memory + 8 * 4'320'000);
  CHECK(changed([](auto& w) { w.blocks = 1000; }).memory == plan.memory + 2'200'000);
  const optimize::Plan none = changed([](auto& w) { w.iterations = 0; });
  CHECK(none.seconds < 0.1 * plan.seconds);
  CHECK(none.memory < plan.memory);
}

TEST_CASE("edges across a layer of one element are counted, those of its surface and of walls are not") {
  const auto layer = [](int first, int end) {
    return testing::cubes(4, [=](Vec3i c) { return c.z >= first && c.z < end ? 1 : 2; });
  };
  // Of six tetrahedra a cube has a diagonal within. Edges along z and diagonals of sides are counted where no wall
  // has them.
  const int within = 4 * 4, of_sides = 2 * 3 * 4, along = 3 * 3;
  CHECK(optimize::count_across(layer(1, 2), 1) == within + of_sides + along);
  CHECK(optimize::count_across(layer(1, 2), 3) == within + of_sides + along);
  CHECK(optimize::count_across(layer(1, 3), 1) == 0);
}

TEST_CASE("elements with angles below 18 degrees, or as far above, are low") {
  TetMesh mesh;
  const auto add = [&](double height) { // over an equilateral triangle
    const auto first = static_cast<int32_t>(mesh.point.size());
    mesh.point.insert(mesh.point.end(), {{1, 0, 0}, {-0.5, 0.866, 0}, {-0.5, -0.866, 0}, {0, 0, height}});
    mesh.tet.push_back({first, first + 1, first + 2, first + 3});
  };
  const double flat = 0.5 * std::tan(18 * 3.14159265358979 / 180);
  for (const double height : {1.4, 1.1 * flat, 0.9 * flat, 0.1 * flat, 0.5})
    add(height);
  CHECK(optimize::count_low(mesh, 1) == 2);
  CHECK(optimize::count_low(mesh, 3) == 2);
}
