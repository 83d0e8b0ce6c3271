// resample_test.cpp — moved densities against the density of the moved atoms.
#include "compose/resample.hpp"
#include "unit/density/completeness.hpp"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace molmesh;
using test::exact_density;

namespace {

Hierarchy moved(Hierarchy h, const Rigid& place) {
  for (Atom& a : h.atom)
    a.center = place(a.center);
  return h;
}

/// The most that values within the band err by, over max(1, G) and in Å; and crossed cells that are not there.
struct Errors {
  double value = 0, distance = 0;
  int64_t missing = 0, wrong_side = 0;
};
Errors compare(const Hierarchy& h, const BlockGrid& g, double allowed) {
  Errors e;
  const BlockIndex index(g);
  const Vec3i n = g.frame.points;
  for (int x = 0; x + 1 < n.x; ++x)
    for (int y = 0; y + 1 < n.y; ++y)
      for (int z = 0; z + 1 < n.z; ++z) {
        const Vec3i p = g.frame.lower + Vec3i{x, y, z};
        const double v = value_at(g, index, p), exact = exact_density(h, g.info.decay, g.frame.position(p));
        const bool close = exact > 0.9 && exact < 1.1;
        if (is_active(g, index, p) && close) {
          const double d = 1e-4;
          Vec3d gradient;
          for (int a = 0; a < 3; ++a) {
            Vec3d q = g.frame.position(p);
            q[a] += d;
            gradient[a] = (std::log(exact_density(h, g.info.decay, q)) - std::log(exact)) / d;
          }
          e.value = std::max(e.value, std::abs(v - exact) / std::max(1.0, exact));
          e.distance = std::max(e.distance, std::abs(std::log(v / exact)) / norm(gradient));
        }
        e.wrong_side += std::abs(exact - 1) > allowed && (v > 1) != (exact > 1);
        bool low = false, high = false, all = true;
        for (int k = 0; k < 8; ++k) {
          const Vec3i q = p + Vec3i{k & 1, k >> 1 & 1, k >> 2};
          const double w = value_at(g, index, q);
          low = low || w <= 1;
          high = high || w > 1;
          all = all && is_active(g, index, q);
        }
        e.missing += low && high && !all;
      }
  return e;
}

} // namespace

TEST_CASE("a single atom is resampled nearly exactly, since the logarithm of its density is quadratic") {
  Hierarchy h;
  h.atom.push_back({{0.3, -0.2, 0.7}, 1.8});
  density::Options o;
  o.spacing = 0.5;
  const BlockGrid g = test::compute(h, o);
  const Rigid place = translation({5, 3, -2}) * rotation({1, 2, -1}, 33, {});
  compose::ResamplingError error;
  const BlockGrid r = compose::resample(g, place, {0.1, 0.2, 0.3}, 1, error);
  const Errors e = compare(moved(h, place), r, 0.01);
  CHECK(e.missing == 0);
  CHECK(e.wrong_side == 0);
  CHECK(e.value < 5e-3);
  CHECK(error.value < 1e-2);
}

TEST_CASE("resampled chains are complete, and err by no more than is reported", "[slow]") {
  for (const double spacing : {0.4, 0.8})
    for (const std::vector<double>& exponents : {std::vector<double>{0.3, 1}, {0.6, 0.8}, {}})
      for (const double lower : {0.9, 0.5}) {
        const Hierarchy h = test::random_chains(1, 8, 6, exponents, 41);
        density::Options o;
        o.spacing = spacing;
        o.band_lower = lower;
        o.band_upper = 2 - lower;
        const BlockGrid g = test::compute(h, o);
        const Rigid place = translation({-4, 13, 2}) * rotation({0.3, -1, 0.4}, 70, {});
        compose::ResamplingError error;
        const BlockGrid r = compose::resample(g, place, {0.05, 0, -0.15}, 1, error);
        const Errors e = compare(moved(h, place), r, 1.5 * error.value);
        INFO("spacing " << spacing << ", band from " << lower << ", levels " << exponents.size() << ": " << e.value
                        << ", " << e.distance << " Å; reported " << error.value << ", " << error.distance
                        << " Å, 99 %: " << error.distance_99 << " Å");
        CHECK(e.missing == 0);
        CHECK(e.wrong_side == 0);
        CHECK(e.value <= 1.5 * error.value);
        CHECK(e.distance < 0.2 * spacing);
      }
}

TEST_CASE("any number of threads resamples to the same bits") {
  density::Options o;
  o.spacing = 0.6;
  const BlockGrid g = test::compute(test::random_chains(2, 8, 6, {0.3, 1}, 2), o);
  compose::ResamplingError one, five;
  const Rigid place = rotation({1, 1, 0}, 20, {});
  test::check_equal(compose::resample(g, place, {0, 0, 0}, 1, one),
                    compose::resample(g, place, {0, 0, 0}, 5, five));
  CHECK(one.value == five.value);
}
