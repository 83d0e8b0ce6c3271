// bodies_test.cpp — bodies without atoms: cores against dense samples, fields against brute force (I1 to I4).
#include "unit/density/completeness.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

namespace {

/// Places of the core, none outside it: corners, edges and the inside of a lattice in the shape's own frame.
double sampled_distance(const Core& core, Vec3d p) {
  double least = 1e300;
  const Vec3d lo = core.low(), size = core.high() - lo;
  constexpr int n = 60;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) {
        const Vec3d q = lo + Vec3d{size.x * i / n, size.y * j / n, size.z * k / n};
        if (core.distance2(q) == 0)
          least = std::min(least, norm(p - q));
      }
  return least;
}

} // namespace

TEST_CASE("the nearest place of a core lies in it, and none is nearer") {
  const Hierarchy h = test::with_bodies({});
  std::mt19937 random(3);
  std::normal_distribution<double> u(0, 9);
  for (const Body& b : h.body) {
    INFO(shape_name(b.shape));
    CHECK(fault_of(b).empty());
    const Core core(b);
    for (int i = 0; i < 4000; ++i) {
      const Vec3d p = b.center + Vec3d{u(random), u(random), u(random)}, near = core.nearest(p);
      REQUIRE(std::sqrt(core.distance2(p)) == Approx(std::sqrt(test::core_distance2(b, p))).margin(1e-9));
      REQUIRE(test::core_distance2(b, near) < 1e-20);
      for (int a = 0; a < 3; ++a) {
        REQUIRE(near[a] <= std::max(core.high()[a] + 1e-9, p[a]));
        REQUIRE((test::core_distance2(b, p) == 0 ||
                 (near[a] <= core.high()[a] + 1e-9 && near[a] >= core.low()[a] - 1e-9)));
      }
    }
    const Vec3d p = b.center + Vec3d{9, -7, 8};
    const double d = std::sqrt(core.distance2(p)), step = norm(core.high() - core.low()) / 60;
    CHECK(sampled_distance(core, p) >= d - 1e-9);
    CHECK(sampled_distance(core, p) <= d + 2 * step);
  }
}

TEST_CASE("a moved body is the body seen from where it was") {
  const Rigid motion = translation({3, 1, -2}) * rotation({1, -2, 0.5}, 50, {1, 1, 1});
  for (const Body& b : test::with_bodies({}).body) {
    const Core core(b), there(moved(b, motion));
    for (const Vec3d p : {Vec3d{1, 2, 3}, Vec3d{-20, 5, 9}, b.center + Vec3d{4, 4, 4}})
      CHECK(there.distance2(motion(p)) == Approx(core.distance2(p)).margin(1e-9));
  }
}

TEST_CASE("with bodies, values are within the tolerance, for any exponents and depth", "[slow]") {
  const std::vector<std::vector<double>> settings = {{},          {1},           {0.3, 1},      {0.5, 1},
                                                     {0.05, 0.5}, {0.02, 0.02},  {2, 1},        {4, 4},
                                                     {0.3, 4},    {0.8, 0.5, 1}, {0.5, 2, 0.5}, {0.3, 0.8, 2.5}};
  int64_t points = 0;
  for (const std::vector<double>& exponents : settings)
    for (const double tolerance : {1e-3, 1e-4, 1e-6}) {
      const Hierarchy h = test::with_bodies(test::random_chains(2, 10, 6, exponents, 17));
      check(h, "h");
      density::Options o;
      o.spacing = 0.8;
      o.tolerance = tolerance;
      std::string text;
      for (const double p : exponents)
        text += std::to_string(p) + " ";
      INFO("exponents, innermost first: " << text << "tolerance " << tolerance);
      const BlockGrid g = test::compute(h, o);
      REQUIRE(!g.corner.empty());
      CHECK(test::worst_error(h, g, 600) <= 1);
      points += 600;
    }
  CHECK(points >= 20000);
}

TEST_CASE("with bodies, no band cell is missed and no point is on the wrong side") {
  for (const std::vector<double>& exponents : {std::vector<double>{0.3, 1}, {0.1, 0.5}, {1, 2}, {}}) {
    const Hierarchy h = test::with_bodies(test::random_chains(2, 8, 6, exponents, 23));
    density::Options o;
    o.spacing = 1.7;
    const BlockGrid g = test::compute(h, o);
    test::check_complete(h, g);
    o.threads = 3;
    test::check_equal(g, test::compute(h, o));
    o.atoms = density::AtomSearch::kdtree;
    test::check_equal(g, test::compute(h, o));
    o.decay = 2;
    o.isovalue = 1.3;
    o.band_lower = 1.2;
    o.band_upper = 1.5;
    test::check_complete(h, test::compute(h, o));
  }
}

TEST_CASE("bodies alone make a field, of which the inside is not evaluated") {
  for (const Body& b : test::with_bodies({}).body) {
    Hierarchy h;
    h.level = {{"residue", {{"b", 0.5, 0, 1}}}};
    h.atom = {{b.center, b.skin}};
    h.body = {b};
    h.body[0].atom = 0;
    density::Options o;
    o.spacing = 1.1;
    test::check_complete(h, test::compute(h, o));
  }
  Hierarchy rod; // across many bricks
  rod.atom = {{{0, 0, 0}, 1.7}};
  rod.body = {{Body::Shape::cylinder, {0, 0, 0}, {100, 60, 30}, {}, 20, 1.7, 0}};
  density::Options o;
  o.spacing = 1;
  density::Counts counts;
  const BlockGrid g = to_block_grid(density::compute(rod, o, counts), 1);
  CHECK(!g.inside.empty());
  CHECK(test::worst_error(rod, g, 2000) <= 1);
  CHECK(counts.search.blocks_evaluated < 3 * static_cast<int64_t>(g.corner.size()) / 2);
}
