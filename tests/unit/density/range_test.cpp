// range_test.cpp — fields whose terms, sums or powers are beyond what floats, or doubles, hold.
#include "base/error.hpp"
#include "unit/density/completeness.hpp"
#include "unit/refusal.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;
using test::compute;

TEST_CASE("terms, powers and sums beyond single precision keep every cell of the band") {
  const auto complete = [](const Hierarchy& h, const density::Options& o) {
    const BlockGrid g = compute(h, o);
    CHECK(std::all_of(g.value.begin(), g.value.end(), [](float v) { return std::isfinite(v); }));
    test::check_complete(h, g);
  };
  density::Options o;
  o.spacing = 1;
  for (const double radius : {9.6, 10.0, 11.5, 14.0, 20.0})
    for (const double exponent : {1.0, 0.3}) {
      INFO("radius " << radius << ", exponent " << exponent);
      Hierarchy h;
      h.atom.push_back({{0.1, 0.2, 0.3}, radius});
      h.level = {{"residue", {{"r", exponent, 0, 1}}}};
      complete(h, o);
    }
  for (const std::vector<double>& exponents : {std::vector<double>{0.3, 1}, {20, 1}, {0.5, 8}}) {
    INFO("innermost exponent " << exponents[0]);
    const Hierarchy h = test::random_chains(2, 8, 6, exponents, 41);
    density::Options steep = o;
    steep.decay = exponents[0] == 0.3 ? 50 : 1;
    steep.tolerance = 1e-4;
    complete(h, steep);
  }
  o.tolerance = 1e-6;
  o.atoms = density::AtomSearch::all;
  Hierarchy two;
  two.atom.push_back({{0, 0, 0}, 11.0});
  two.atom.push_back({{14, 3, 2}, 2.0});
  complete(two, o);
}

TEST_CASE("powers so small that the sums below them need more range than doubles have") {
  density::Options o;
  o.spacing = 1.1;
  for (const std::vector<double>& exponents : {std::vector<double>{0.5, 0.02}, {0.4, 0.03, 0.5}, {4, 0.02}}) {
    Hierarchy h = test::random_chains(3, 10, 5, exponents, 7);
    for (size_t i = 0; i < h.atom.size() / 3; ++i) // a chain that is far away counts there, too
      h.atom[i].center = h.atom[i].center + Vec3d{40, 15, -10};
    for (const double tolerance : {1e-3, 1e-6}) {
      INFO("innermost exponent " << exponents[0] << ", tolerance " << tolerance);
      o.tolerance = tolerance;
      CHECK(test::worst_error(h, compute(h, o), 300) <= 1);
      const Hierarchy weighted = test::with_weights(h, 2); // a chain's 0.3 is e^-60 for its atoms
      CHECK(test::worst_error(weighted, compute(weighted, o), 300) <= 1);
    }
  }
}

TEST_CASE("sums beyond doubles, whose powers are not", "[slow]") {
  Hierarchy h = test::random_chains(2, 8, 6, {1, 0.5}, 5);
  for (Atom& a : h.atom)
    a.radius += 26;
  density::Options o;
  o.spacing = 1;
  const BlockGrid g = compute(h, o);
  CHECK(test::worst_error(h, g, 300) <= 1);
  test::check_complete(h, g);
}

TEST_CASE("a value that a float does not hold is refused where the file would need it") {
  Hierarchy h;
  h.atom.push_back({{0, 0, 0}, 40.0});
  density::Options o;
  o.spacing = 2;
  CHECK(test::refusal(Status::usage, [&] { compute(h, o); }).find("a smaller spacing") != std::string::npos);
  o.decay = 1e6;
  CHECK(test::refusal(Status::usage, [&] { compute(h, o); }).find("a smaller decay") != std::string::npos);
}
