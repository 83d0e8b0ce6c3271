// shape_test.cpp — how flat elements are: eight at once as one by one, to the last bit, by every instruction set.
#include "contour/elements/least_sine.hpp"
#include "geom/tet_measures.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <hwy/targets.h>
#include <random>
#include <vector>

using namespace molmesh;
using contour::least_sine;
using contour::least_sines;

namespace {

using Element = std::array<Vec3d, 4>;

/// Of every shape: the fourth corner near the plane of the others, on both sides; some flat, some with corners that
/// meet.
std::vector<Element> elements(int n) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto random = [&] { return Vec3d{u(generator), u(generator), u(generator)}; };
  std::vector<Element> all;
  for (int i = 0; i < n; ++i) {
    Element e{random(), random(), random(), random()};
    if (i % 3 == 0)
      e[3] = e[0] + 0.3 * (e[1] - e[0]) + 0.4 * (e[2] - e[0]) + std::pow(0.1, i % 17) * random();
    if (i % 11 == 0)
      e[3] = e[i % 3];
    all.push_back(e);
  }
  return all;
}

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

} // namespace

TEST_CASE("the least sine is that of the dihedral angles, negative for an inverted element") {
  int positive = 0;
  for (const Element& e : elements(2000)) {
    const DihedralTrig t = dihedral_trig(e[0], e[1], e[2], e[3]);
    const double least = least_sine(e[0], e[1], e[2], e[3]), volume = six_volume(e[0], e[1], e[2], e[3]);
    positive += volume > 0;
    CHECK(same(least, volume > 0 ? *std::min_element(t.sine, t.sine + 6) : -1));
  }
  CHECK(positive > 500);
}

TEST_CASE("least sines of many elements are those of one after the other") {
  const std::vector<Element> all = elements(400);
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    INFO(hwy::TargetName(target));
    for (int n = 1; n <= 17; ++n)
      for (size_t first = 0; first + static_cast<size_t>(n) <= all.size(); first += static_cast<size_t>(n)) {
        double least[18];
        least[n] = 7;
        least_sines(
            n, [&](int i, int k) { return all[first + static_cast<size_t>(i)][k]; }, least);
        CHECK(least[n] == 7);
        for (int i = 0; i < n; ++i) {
          const Element& e = all[first + static_cast<size_t>(i)];
          CHECK(same(least[i], least_sine(e[0], e[1], e[2], e[3])));
        }
      }
  }
  hwy::SetSupportedTargetsForTest(0);
}
