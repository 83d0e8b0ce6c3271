// plan_test.cpp — a plan counts few points, and tells of many.
#include "base/error.hpp"
#include "density/plan.hpp"
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;

namespace {

Hierarchy ball(double radius) {
  Hierarchy h;
  Atom a;
  a.radius = radius;
  h.atom.push_back(a);
  return h;
}

} // namespace

TEST_CASE("a great ball is planned by a coarser grid") {
  density::Options o;
  o.decay = 0.01;
  o.spacing = 0.5;
  const density::Plan plan = density::plan(ball(200), o);
  CHECK(plan.counted.spacing == 1);
  density::Counts counts;
  int64_t blocks = 0;
  o.take = [&](const FieldInfo&, std::span<const BandBlocks> runs) {
    for (const BandBlocks& r : runs)
      blocks += std::ssize(r);
  };
  const Band band = density::compute(ball(200), o, counts);
  CHECK(std::abs(double(plan.size.active_points) / double(band.active_points) - 1) < 0.05);
  CHECK(std::abs(double(plan.size.blocks) / double(blocks) - 1) < 0.05);
  CHECK(std::abs(plan.size.points.x - band.frame.points.x) <= 8);
}

TEST_CASE("where the coarser grid of a plan has values beyond floats, they are the largest float") {
  density::Options o;
  o.spacing = 0.25;
  const density::Plan plan = density::plan(ball(100), o);
  CHECK(plan.counted.spacing > o.spacing);
  CHECK(plan.size.active_points > 1'000'000);
  for (const float v : to_block_grid(plan.band, 1).value)
    if (!std::isfinite(v))
      FAIL("found " << v);
}

TEST_CASE("a plan refuses a great ball whose values are beyond floats on the run's own grid") {
  density::Options o;
  o.spacing = 0.5;
  CHECK_THROWS_WITH(density::plan(ball(1000), o), Catch::Contains("beyond the file's single precision"));
}

TEST_CASE("a great body without atoms is known as one by its surface") {
  Hierarchy h = ball(1);
  Body b;
  b.size = 2000;
  b.skin = 1;
  h.body.push_back(b);
  CHECK(density::of_great_balls(h));
  CHECK(density::most_active_points(h) > 4e7);
  density::Options o;
  o.spacing = 0.5;
  const density::Plan plan = density::plan(h, o);
  CHECK(plan.counted.spacing > 2);
  const double share = double(plan.size.active_points) / (density::most_active_points(h) / (o.spacing * o.spacing));
  CHECK(share > 0.6);
  CHECK(share <= 1);
  h.body[0].size = 200;
  CHECK_FALSE(density::of_great_balls(h));
}

TEST_CASE("a body that is long and thin is planned by a grid that cannot miss it", "[slow]") {
  Hierarchy h = ball(1);
  Body b;
  b.shape = Body::Shape::capsule;
  b.u = {3e5, 0, 0};
  b.size = 3;
  b.skin = 1;
  h.body.push_back(b);
  density::Options o;
  o.spacing = 3;
  REQUIRE(density::of_great_balls(h));
  const density::Plan plan = density::plan(h, o);
  CHECK(plan.counted.spacing == 3);
  CHECK(plan.size.active_points > 100'000);
}

TEST_CASE("a field that no spacing allows is refused before it is planned") {
  density::Options o;
  CHECK_THROWS_WITH(density::check_field(ball(1e4), o), Catch::Contains("logarithm reaches 1e+08"));
  CHECK_NOTHROW(density::check_field(ball(9e3), o));
}
