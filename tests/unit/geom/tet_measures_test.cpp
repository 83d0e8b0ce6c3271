// tet_measures_test.cpp — measures of tetrahedra whose values are known.
#include "geom/tet_measures.hpp"
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;

TEST_CASE("the regular tetrahedron has quality 1") {
  const Vec3d a{1, 1, 1}, b{1, -1, -1}, c{-1, -1, 1}, d{-1, 1, -1};
  CHECK(tet_volume(a, b, c, d) == Approx(8.0 / 3)); // a cube of side 2 less four corners
  const double q = joe_liu_q(six_volume(a, b, c, d), edge_sum2(a, b, c, d));
  CHECK(q == Approx(1).epsilon(1e-14));
  CHECK(joe_liu_eta(q) == Approx(1).epsilon(1e-14));
  CHECK(edge_ratio(a, b, c, d) == Approx(1));
  for (double degree : dihedrals(a, b, c, d).degree)
    CHECK(degree == Approx(70.528779365509308)); // acos(1/3)
  for (double degree : dihedrals(a, c, b, d).degree)
    CHECK(degree == Approx(-70.528779365509308));
}

TEST_CASE("the corner tetrahedron") {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1};
  CHECK(tet_volume(a, b, c, d) == Approx(1.0 / 6));
  const Dihedrals angle = dihedrals(a, b, c, d);
  for (int e = 0; e < 3; ++e)
    CHECK(angle.degree[e] == Approx(90)); // edges at the corner
  for (int e = 3; e < 6; ++e)
    CHECK(angle.degree[e] == Approx(54.735610317245346)); // acos(1/√3)
  CHECK(edge_ratio(a, b, c, d) == Approx(std::sqrt(2)));
  CHECK(tri_area(b, c, d) == Approx(std::sqrt(3) / 2));
  CHECK(dot(tri_normal(b, c, d), Vec3d{1, 1, 1}) > 0);
}

TEST_CASE("eta to the power 3/2 is equation 8, and both follow their definitions") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    const auto point = [&] { return Vec3d{u(random), u(random), u(random)}; };
    Vec3d a = point(), b = point(), c = point(), d = point();
    if (six_volume(a, b, c, d) < 0)
      std::swap(c, d);
    const double v = tet_volume(a, b, c, d), sum2 = edge_sum2(a, b, c, d), q = joe_liu_q(6 * v, sum2);
    CHECK(q == Approx(8 * std::pow(3, 2.5) * v / std::pow(sum2, 1.5)));
    CHECK(joe_liu_eta(q) == Approx(12 * std::pow(3 * v, 2.0 / 3) / sum2));
    CHECK(std::pow(joe_liu_eta(q), 1.5) == Approx(q));
    CHECK(q < 1 + 1e-14);
  }
}

TEST_CASE("dihedral angles agree with the angle between the half planes at each edge") {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    Vec3d p[4];
    for (Vec3d& x : p)
      x = {u(random), u(random), u(random)};
    const Dihedrals angle = dihedrals(p[0], p[1], p[2], p[3]);
    const bool positive = six_volume(p[0], p[1], p[2], p[3]) > 0;
    for (int e = 0; e < 6; ++e) {
      const Vec3d from = p[tet_edge(e, 0)], axis = p[tet_edge(e, 1)] - from;
      const auto across = [&](int end) {
        const Vec3d x = p[tet_edge(5 - e, end)] - from;
        return x - dot(x, axis) / norm2(axis) * axis;
      };
      const Vec3d x = across(0), y = across(1);
      const double expected = std::acos(dot(x, y) / (norm(x) * norm(y))) * 180 / std::acos(-1.0);
      CHECK(angle.degree[e] == Approx(positive ? expected : -expected).margin(1e-6));
    }
  }
}

TEST_CASE("faces look out, and no face holds its own corner") {
  const Vec3d p[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int f = 0; f < 4; ++f) {
    const Vec3d a = p[tet_face(f, 0)], b = p[tet_face(f, 1)], c = p[tet_face(f, 2)];
    CHECK(dot(tri_normal(a, b, c), p[f] - a) < 0);
    for (int i = 0; i < 3; ++i)
      CHECK(tet_face(f, i) != f);
  }
}
