// predicates_test.cpp — orient3d against rational arithmetic on nearly degenerate points.
#include "geom/predicates.hpp"
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;

namespace {

/// A double as the integer x·2^1074.
boost::multiprecision::cpp_int integer(double x) {
  int exponent = 0;
  const auto mantissa = static_cast<int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  boost::multiprecision::cpp_int i = mantissa;
  return i << (exponent - 53 + 1074);
}

int oracle(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  boost::multiprecision::cpp_int m[3][3];
  const Vec3d row[3] = {b, c, d};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      m[i][k] = integer(row[i][k]) - integer(a[k]);
  const boost::multiprecision::cpp_int det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return det.sign();
}

} // namespace

TEST_CASE("orient3d is exact on nearly coplanar points") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  int zeros = 0, decided_by_expansions = 0;
  for (int n = 0; n < 20'000; ++n) {
    const double scale = std::ldexp(1.0, static_cast<int>(random() % 60) - 30), far = n % 3 == 0 ? 1000 : 1;
    const auto point = [&] {
      return Vec3d{far + scale * unit(random), scale * unit(random), scale * unit(random)};
    };
    const Vec3d a = point(), b = point(), c = point();
    const double s = unit(random), t = unit(random);
    Vec3d d = a + s * (b - a) + t * (c - a); // coplanar up to rounding
    if (n % 5 == 1)
      d.x = std::nextafter(d.x, 2e9);
    if (n % 5 == 2)
      d = a + std::ldexp(1.0, -static_cast<int>(random() % 8)) * (b - a); // often exactly on the line
    const int expected = oracle(a, b, c, d);
    zeros += expected == 0;
    decided_by_expansions += std::fabs(dot(cross(b - a, c - a), d - a)) < 1e-15 * scale * scale * scale;
    REQUIRE(orient3d(a, b, c, d) == expected);
    REQUIRE(orient3d(b, a, c, d) == -expected);
    REQUIRE(orient3d(c, d, a, b) == expected);
    REQUIRE(detail::orient3d_exact(a, b, c, d) == expected);
  }
  CHECK(zeros > 100);
  CHECK(decided_by_expansions > 1000);
}

TEST_CASE("orient3d is exact at the ends of its range") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0.5, 1);
  for (int n = 0; n < 2000; ++n) {
    const auto coordinate = [&] { return std::ldexp(unit(random), static_cast<int>(random() % 610) - 285); };
    const auto point = [&] { return Vec3d{coordinate(), -coordinate(), coordinate()}; };
    const Vec3d a = point(), b = point(), c = point(), d = point();
    REQUIRE(orient3d(a, b, c, d) == oracle(a, b, c, d));
    REQUIRE(orient3d(a, b, c, b) == 0);
  }
}

TEST_CASE("orient3d is positive in VTK's order") {
  CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}) == 1);
  CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}) == -1);
  CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.7, 0}) == 0);
}
