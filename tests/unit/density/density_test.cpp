// density_test.cpp — the sparse grid against the field summed by brute force: I1 to I4.
#include "base/error.hpp"
#include "density/density.hpp"
#include "density/values/block_sums_simd.hpp"
#include "unit/density/completeness.hpp"
#include "unit/refusal.hpp"
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <hwy/targets.h>
#include <new>

using namespace molmesh;
using test::check_equal;
using test::compute;

TEST_CASE("values are within the tolerance for exponents from 0.02 to 4 and any depth") {
  const std::vector<std::vector<double>> settings = {
      {},           {1},           {0.3, 1},  {0.5, 1},    {0.05, 0.5},   {0.02, 1},
      {0.02, 0.02}, {2, 1},        {1, 0.02}, {4, 0.25},   {0.3, 4},      {0.8, 0.5, 1},
      {2, 1, 1},    {0.5, 2, 0.5}, {4, 4},    {1, 1, 0.3}, {0.7, 0.4, 1}, {0.3, 0.8, 2.5}};
  for (const std::vector<double>& exponents : settings)
    for (const double tolerance : {1e-3, 1e-4, 1e-6}) {
      const Hierarchy h = test::random_chains(3, 12, 6, exponents, 17);
      density::Options o;
      o.spacing = 0.8;
      o.tolerance = tolerance;
      const BlockGrid g = compute(h, o);
      std::string text;
      for (const double p : exponents)
        text += std::to_string(p) + " ";
      INFO("exponents, innermost first: " << text << "tolerance " << tolerance);
      REQUIRE(!g.corner.empty());
      CHECK(test::worst_error(h, g, 100) <= 1);
    }
}

TEST_CASE("with weights, values are within the tolerance, no band cell is missed, and sides are right") {
  for (const std::vector<double>& exponents : {std::vector<double>{0.38, 1},
                                               {0.3},
                                               {0.5, 2},
                                               {2, 0.7},
                                               {0.8, 0.5, 1},
                                               {0.5, 0.05},
                                               {1, 1},
                                               {0.02, 1},
                                               {0.5, 1}})
    for (const bool bodies : {false, true}) {
      const Hierarchy chains = test::random_chains(3, 12, 6, exponents, 17),
                      h = test::with_weights(bodies ? test::with_bodies(chains) : chains, 3);
      check(h, "h");
      std::string text;
      for (const double p : exponents)
        text += std::to_string(p) + " ";
      INFO("exponents, innermost first: " << text << (bodies ? "with bodies" : ""));
      density::Options o;
      o.spacing = bodies ? 1.9 : 1;
      const BlockGrid g = compute(h, o);
      REQUIRE(!g.corner.empty());
      for (const double tolerance : {1e-3, 1e-4, 1e-6}) {
        o.tolerance = tolerance;
        CHECK(test::worst_error(h, compute(h, o), 200) <= 1);
      }
      test::check_complete(h, g);
      o.tolerance = g.info.tolerance;
      o.threads = 3;
      test::check_equal(g, compute(h, o));
      o.atoms = density::AtomSearch::kdtree;
      test::check_equal(g, compute(h, o));
    }
}

TEST_CASE("a weight is a factor on the terms of its atoms, wherever it stands") {
  const Hierarchy h = test::random_chains(2, 9, 6, {0.4, 2}, 5);
  Hierarchy outer = h, inner = h, larger = h;
  for (Group& chain : outer.level[0].group)
    chain.weight = 0.7;
  for (Group& residue : inner.level[1].group)
    residue.weight = std::pow(0.7, 1 / 0.4);
  for (Atom& a : larger.atom)
    a.radius = std::sqrt(a.radius * a.radius + std::log(0.7) / 0.4);
  density::Options o;
  o.spacing = 0.9;
  const BlockGrid g = compute(outer, o);
  CHECK(g.corner.size() > 4);
  for (const Hierarchy* same : {&inner, &larger}) {
    const BlockGrid other = compute(*same, o);
    CHECK(other.corner == g.corner);
    CHECK(test::worst_error(*same, g, 200) <= 1);
  }
}

TEST_CASE("weights whose logarithm is beyond use are refused") {
  Hierarchy h = test::random_chains(2, 9, 6, {1e-9, 1}, 5);
  h.level[0].group[0].weight = 0.5;
  CHECK(test::refusal(Status::usage, [&] { compute(h, {}); }) ==
        "a group's weight counts e^-6.93147e+08 for each of its atoms, expected less than e^1e8 and more than its "
        "inverse: a larger exponent");
}

TEST_CASE("no band cell is missed and no point is on the wrong side") {
  for (const std::vector<double>& exponents : {std::vector<double>{0.3, 1}, {0.5, 1}, {0.1, 0.5}, {1, 2}, {}}) {
    density::Options o;
    o.spacing = 1.1;
    const Hierarchy h = test::random_chains(2, 15, 6, exponents, 23);
    test::check_complete(h, compute(h, o));
  }
}

TEST_CASE("molecules far apart, a hollow ball and a cavity of one cell are all found") {
  density::Options o;
  o.spacing = 1.0;
  o.isovalue = 1;
  Hierarchy far;
  far.atom.push_back({{0, 0, 0}, 2.0});
  far.atom.push_back({{100, 3, -2}, 1.5});
  far.atom.push_back({{40, 0.2, 0.1}, 1.7});
  density::Options coarse = o;
  coarse.spacing = 1.3;
  test::check_complete(far, compute(far, coarse));

  Hierarchy hollow;
  for (int i = 0; i < 400; ++i) { // Fibonacci sphere
    const double z = 1 - (2 * i + 1) / 400.0, t = 2.399963229728653 * i, r = std::sqrt(1 - z * z);
    hollow.atom.push_back({{12 * r * std::cos(t), 12 * r * std::sin(t), 12 * z}, 1.7});
  }
  test::check_complete(hollow, compute(hollow, o));

  Hierarchy cage; // atoms on a lattice, one missing
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z)
        if (x || y || z)
          cage.atom.push_back({{1.7 * x, 1.7 * y, 1.7 * z}, 1.2});
  o.spacing = 0.7;
  o.isovalue = 3.2;
  o.band_lower = 3;
  o.band_upper = 3.4;
  const BlockGrid g = compute(cage, o);
  test::check_complete(cage, g);
}

TEST_CASE("an atom far from the others of its residue costs no search between them") {
  Hierarchy h = test::random_chains(1, 6, 7, {0.5, 1}, 5);
  h.atom[3].center = {9999, 9999, 9999};
  density::Options o;
  o.spacing = 1;
  density::Counts counts;
  const Band band = density::compute(h, o, counts);
  CHECK(counts.search.blocks_visited < 1000);
  CHECK(test::worst_error(h, to_block_grid(band, 1), 100) <= 1);
}

TEST_CASE("full and neighbor search, and any number of threads, give the same grid") {
  const Hierarchy h = test::random_chains(3, 40, 8, {0.4, 1}, 3);
  density::Options o;
  o.spacing = 0.6;
  const BlockGrid one = compute(h, o);
  for (const int threads : {2, 3, 8}) {
    o.threads = threads;
    const BlockGrid many = compute(h, o);
    check_equal(many, one);
    CHECK(many.info.analyzed_points == one.info.analyzed_points);
  }
  o.full_search = true;
  check_equal(compute(h, o), one);
}

TEST_CASE("a kd-tree finds what the boxes find, and all atoms give the same field within the tolerance") {
  for (const std::vector<double>& exponents : {std::vector<double>{0.4, 1}, {0.3, 0.5}, {}}) {
    const Hierarchy h = test::random_chains(3, 12, 8, exponents, 3);
    density::Options o;
    o.spacing = 0.9;
    const BlockGrid bvh = compute(h, o);
    o.atoms = density::AtomSearch::kdtree;
    check_equal(compute(h, o), bvh);
    o.atoms = density::AtomSearch::all;
    const BlockGrid all = compute(h, o);
    CHECK(test::worst_error(h, all, 200) <= 0.1);
    test::check_complete(h, all);
    Hierarchy apart = h; // terms far below what doubles hold
    for (size_t i = apart.atom.size() / 2; i < apart.atom.size(); ++i)
      apart.atom[i].center = apart.atom[i].center + Vec3d{90, 40, -30};
    CHECK(test::worst_error(apart, compute(apart, o), 200) <= 0.1);
  }
}

TEST_CASE("every instruction set of this machine keeps the bound, in single, double and logarithms") {
  const int64_t here = hwy::SupportedTargets();
  std::vector<std::string> names;
  for (const int64_t set : {HWY_SCALAR, HWY_SSE4, HWY_AVX2, HWY_AVX3}) {
    if (set != HWY_SCALAR && !(here & set))
      continue;
    hwy::SetSupportedTargetsForTest(set);
    names.push_back(density::instruction_set());
    for (const std::vector<double>& exponents : {std::vector<double>{0.3, 1}, {0.5, 1}, {2, 0.7}})
      for (const double tolerance : {1e-4, 1e-6}) {
        INFO(names.back() << ", innermost exponent " << exponents[0] << ", tolerance " << tolerance);
        const Hierarchy h = test::random_chains(3, 12, 20, exponents, 11);
        density::Options o;
        o.spacing = 0.6;
        o.tolerance = tolerance;
        const BlockGrid g = compute(h, o);
        CHECK(test::worst_error(h, g, 300) <= 1);
        o.threads = 3;
        check_equal(compute(h, o), g);
      }
    // Far coarser than the atoms: sums are carried as logarithms.
    for (const std::vector<double>& exponents : {std::vector<double>{0.1, 0.5}, {0.05}, {0.1, 2, 0.3}, {1, 0.4}})
      for (const double spacing : {4.0, 7.0}) {
        INFO(names.back() << ", innermost exponent " << exponents[0] << ", spacing " << spacing);
        Hierarchy h = test::random_chains(4, 40, 9, exponents, 12);
        if (exponents.size() == 2)
          h = test::with_bodies(std::move(h));
        density::Options o;
        o.spacing = spacing;
        o.tolerance = spacing == 4 ? 1e-6 : 1e-4;
        CHECK(test::worst_error(h, compute(h, o), 300) <= 1);
      }
  }
  hwy::SetSupportedTargetsForTest(0);
  std::sort(names.begin(), names.end());
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end()); // the sets were really different ones
}

TEST_CASE("one atom is a sphere of its radius") {
  Hierarchy h;
  h.atom.push_back({{1, 2, 3}, 2.0});
  for (const double spacing : {1.0, 0.3, 0.1}) {
    density::Options o;
    o.spacing = spacing;
    const BlockGrid g = compute(h, o);
    const BlockIndex index(g);
    int64_t wrong = 0;
    for (int x = 0; x < g.frame.points.x; ++x)
      for (int y = 0; y < g.frame.points.y; ++y)
        for (int z = 0; z < g.frame.points.z; ++z) {
          const double d = norm(g.frame.position({x, y, z}) - h.atom[0].center);
          if (std::abs(d - 2) > 1e-4)
            wrong += (value_at(g, index, {x, y, z}) > 1) != (d < 2);
        }
    CHECK(wrong == 0);
  }
}

TEST_CASE("the derived margin keeps the band off the wall, a small one is refused") {
  for (const std::vector<double>& exponents : {std::vector<double>{0.3, 1}, {0.05, 0.5}, {0.02, 1}}) {
    const Hierarchy h = test::random_chains(2, 30, 7, exponents, 29);
    density::Options o;
    o.spacing = 1.5;
    const BlockGrid g = compute(h, o);
    const BlockIndex index(g);
    const Vec3i last = g.frame.lower + g.frame.points - Vec3i{1, 1, 1};
    int64_t touched = 0;
    for (const Vec3i& c : g.corner)
      for (int s = 0; s < 512; ++s) {
        const Vec3i p = c + within_block(s);
        const bool wall = p.x <= 0 || p.y <= 0 || p.z <= 0 || p.x >= last.x || p.y >= last.y || p.z >= last.z;
        touched += wall && is_active(g, index, p);
      }
    CHECK(touched == 0);
    o.margin = 0;
    CHECK(test::refusal(Status::failed, [&] { compute(h, o); }).find("margin") != std::string::npos);
  }
}

TEST_CASE("a field that never reaches the band is refused") {
  Hierarchy h;
  h.atom.push_back({{1, 2, 3}, 2.0});
  density::Options o;
  o.isovalue = 1e6;
  o.band_lower = 0.9e6;
  o.band_upper = 1.1e6;
  CHECK(test::refusal(Status::failed, [&] { compute(h, o); }).find("isovalue") != std::string::npos);
}

TEST_CASE("a band narrower than the tolerance is refused") {
  Hierarchy h;
  h.atom.push_back({{0, 0, 0}, 2.0});
  const auto with = [&](double isovalue, double tolerance) {
    density::Options o;
    o.isovalue = isovalue;
    o.band_lower = 0.9 * isovalue;
    o.band_upper = 1.1 * isovalue;
    o.tolerance = tolerance;
    return test::refusal(Status::usage, [&] { compute(h, o); });
  };
  for (const auto& [isovalue, tolerance] : {std::pair{1e-4, 1e-4}, {0.02, 0.01}, {9.9e-4, 1e-4}, {1e-300, 1e-4}})
    CHECK(with(isovalue, tolerance).find("tolerance: ") != std::string::npos);
  for (const auto& [isovalue, tolerance] : {std::pair{1.01e-3, 1e-4}, {0.11, 0.01}, {1.0, 0.01}, {5.0, 0.01}})
    CHECK(with(isovalue, tolerance).empty());
  CHECK(with(1e38, 1e-4).find("[isovalue]") != std::string::npos);
}

TEST_CASE("fields without an end are refused, not searched for it") {
  density::Options o;
  o.spacing = 1;
  const auto refused = [&](double radius, double exponent, double decay) {
    Hierarchy h;
    h.atom.push_back({{0, 0, 0}, radius});
    h.atom.push_back({{1, 0, 0}, radius});
    h.level = {{"residue", {{"r", exponent, 0, 1}, {"s", exponent, 1, 2}}}};
    o.decay = decay;
    return !test::refusal(Status::usage, [&] { compute(h, o); }).empty();
  };
  CHECK(refused(1.7, 0.3, 1e-300));
  CHECK(refused(1.7, 0.3, 1e-100));
  CHECK(refused(1e100, 0.3, 1));
  CHECK(refused(1e200, 0.3, 1)); // its square is no number
  CHECK(refused(1.7, 1e-300, 1));
}

TEST_CASE("a hundred thousand atoms and ten thousand groups in one block are counted in more than 31 bits",
          "[slow]") {
  Hierarchy h;
  h.level.push_back({"crowd", {}});
  for (int64_t i = 0; i < 216000; ++i)
    h.atom.push_back({{0, 0, 0}, i == 0 ? 1.5 : 1});
  h.level[0].group.push_back({"big", 0.9, 0, 216000});
  for (int64_t i = 0; i < 12000; ++i) {
    h.atom.push_back({{0, 0, 0}, 1.41});
    h.level[0].group.push_back({"s", 1, 216000 + i, 216001 + i});
  }
  density::Options o;
  o.spacing = 0.3;
  CHECK(test::worst_error(h, test::compute(h, o), 20) <= 1);
}

TEST_CASE("spacings far beyond an atom's reach are refused") {
  Hierarchy h;
  h.atom = {{{0, 0, 0}, 1.7}, {{14000000.6, 0.3, 0}, 1.7}};
  density::Options o;
  o.spacing = o.margin = 1e6;
  CHECK(test::refusal(Status::usage, [&] { test::compute(h, o); }).find("a smaller spacing") != std::string::npos);
  o.grid_points = 5;
  CHECK(test::refusal(Status::usage, [&] { test::compute(h, o); }).find("a larger grid") != std::string::npos);
}

TEST_CASE("sums of very many terms are within the tolerance", "[slow]") {
  for (const Hierarchy& h : test::crowds(30000))
    for (const double tolerance : {1e-3, 1e-4, 4.1e-5})
      for (const double spacing : {0.5, 1.5}) // with a reference for each unit's terms, and without
        CHECK(test::worst_error(h, compute(h, test::around_a_crowd(tolerance, spacing)), 40) <= 1);
}

TEST_CASE("a thread that fails ends the search, and what others read stays until they have stopped") {
  const Hierarchy h = test::random_chains(4, 10, 10, {0.3, 1}, 8);
  density::Options o;
  o.spacing = 0.3;
  o.threads = 4;
  std::atomic<int> calls = 0;
  int fails_at = 0;
  o.progress = [&](int64_t, int64_t) {
    if (++calls == fails_at)
      throw std::bad_alloc();
  };
  compute(h, o);
  const int all = calls;
  REQUIRE(all > 30);
  for (fails_at = 1; fails_at <= all; fails_at += 7) {
    calls = 0;
    CHECK_THROWS_AS(compute(h, o), std::bad_alloc);
  }
}
