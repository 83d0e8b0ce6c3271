// reference_surface_test.cpp — closest points of a surface of thin triangles, against a search over all of them.
#include "isosurface/reference_surface.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace molmesh;

namespace {

/// n thin triangles round a slanted axis, and a second turn of them above.
TetMesh fan(int n) {
  TetMesh m;
  m.point = {{0, 0, 0}, {0.3, 0.1, 1}};
  const auto outer = [&](int i) {
    const double angle = 2 * 3.14159265358979323846 * i / n;
    return Vec3d{std::cos(angle), std::sin(angle), 0.4 * std::cos(3 * angle)};
  };
  for (int i = 0; i < n; ++i)
    m.point.push_back(outer(i));
  for (int i = 0; i < n; ++i)
    for (const int32_t apex : {0, 1}) {
      m.tri.push_back({apex, 2 + i, 2 + (i + 1) % n});
      m.boundary.push_back(1);
    }
  return m;
}

double to_segment(Vec3d a, Vec3d b, Vec3d p) {
  const double t = std::clamp(dot(p - a, b - a) / norm2(b - a), 0., 1.);
  return norm(p - (a + t * (b - a)));
}

double to_triangle(Vec3d a, Vec3d b, Vec3d c, Vec3d p) {
  const Vec3d n = cross(b - a, c - a);
  const auto inner = [&](Vec3d u, Vec3d v) { return dot(cross(v - u, p - u), n) >= 0; };
  if (inner(a, b) && inner(b, c) && inner(c, a))
    return std::fabs(dot(p - a, n)) / norm(n);
  return std::min({to_segment(a, b, p), to_segment(b, c, p), to_segment(c, a, p)});
}

} // namespace

TEST_CASE("reference surface: the closest point of thin triangles is that of a search over all") {
  const TetMesh m = fan(300);
  const ReferenceSurface surface(m, std::vector<uint8_t>(m.tri.size(), 1));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(-1.2, 1.2);
  const double reach = 0.9 * surface.spacing();
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Tri& near = m.tri[size_t(i) % m.tri.size()]; // a place of the surface, and a way off it
    const double u = 0.5 + 0.4 * at(random), v = (1 - u) * (0.5 + 0.4 * at(random));
    const Vec3d on = u * m.point[near[0]] + v * m.point[near[1]] + (1 - u - v) * m.point[near[2]];
    const Vec3d p = on + reach * Vec3d{at(random), at(random), at(random)};
    double least = 1e300;
    for (const Tri& t : m.tri)
      least = std::min(least, to_triangle(m.point[t[0]], m.point[t[1]], m.point[t[2]], p));
    Vec3d q = p;
    const bool is_near = surface.project(q, reach);
    Vec3d again = p; // an answer that was kept
    REQUIRE(surface.project(again, reach) == is_near);
    REQUIRE(again == q);
    if (std::fabs(least - reach) < 1e-9)
      continue;
    REQUIRE(is_near == (least < reach));
    if (is_near)
      REQUIRE(std::fabs(norm(q - p) - least) < 1e-9);
    found += is_near;
  }
  CHECK(found > 500);
}
