// far_division_test.cpp — an edge divided and joined again; a far one whose new vertex needs room.
#include "contour/surface_distance/far_division.hpp"
#include "geom/tet_measures.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace molmesh;
using contour::FarPatch;

namespace {

constexpr int32_t ring = 6;

/// An edge of length 2 along z with a ring of elements of radius 1 round it, and two triangles on opposite sides of
/// that, in the plane y = 0. closed: with the last element.
FarPatch ring_patch(bool closed) {
  FarPatch p;
  p.position = {{0, 0, -1}, {0, 0, 1}};
  for (int32_t i = 0; i < ring; ++i) {
    const double turn = 2 * M_PI * i / ring;
    p.position.push_back({std::cos(turn), std::sin(turn), 0});
    if (closed || i + 1 < ring)
      p.element.push_back({i, {0, 1, 2 + i, 2 + (i + 1) % ring}, 0, 1});
  }
  p.triangle = {{0, 0, {0, 1, 2}, 0}, {1, 1, {1, 0, 2 + ring / 2}, 0}};
  p.is_free.assign(p.position.size(), 0);
  p.find_stars();
  return p;
}

double volume6(const FarPatch& p, const Tet& t) {
  const auto x = [&](size_t i) { return p.position[t[i]]; };
  return six_volume(x(0), x(1), x(2), x(3));
}

/// What find_stars would find is there, in whatever order.
bool stars_hold(const FarPatch& p) {
  FarPatch anew = p;
  anew.find_stars();
  bool same = true;
  for (int32_t v = 0; v < static_cast<int32_t>(p.position.size()); ++v) {
    same = same && std::is_permutation(p.elements_at(v).begin(), p.elements_at(v).end(),
                                       anew.elements_at(v).begin(), anew.elements_at(v).end());
    same = same && std::is_permutation(p.triangles_at(v).begin(), p.triangles_at(v).end(),
                                       anew.triangles_at(v).begin(), anew.triangles_at(v).end());
  }
  return same;
}

/// y = 0.7 Å over one place of the plane y = 0, and next to nothing an Å away.
struct Bump {
  static constexpr double height = 0.7, width2 = 0.3;
  double distance(Vec3d x) const {
    const double dx = x.x + 0.5, dz = x.z + 0.5;
    return x.y - height * std::exp(-(dx * dx + dz * dz) / width2);
  }
  double spacing() const { return 1; }
  bool probe(Vec3d x, double& d, Vec3d& normal) const {
    d = distance(x);
    normal = {0, 1, 0};
    return true;
  }
  bool project(Vec3d& x, double) const {
    x.y -= distance(x);
    return true;
  }
};

constexpr float goal = 0.05F;
constexpr double shape = 0.01;
constexpr int n = 5; // points on each axis

float quality(const FarPatch& p, const Tet& t) {
  const auto x = [&](size_t i) { return p.position[t[i]]; };
  return tet_quality(x(0), x(1), x(2), x(3), shape);
}
float off(const FarPatch& p, const Tri& t) {
  Vec3d centroid;
  for (const int32_t v : t)
    centroid += p.position[v] / 3.;
  return contour::CentroidDistance::of(Bump{}, centroid);
}

/// Cubes in six tetrahedra each. The surface is y = 0; the points above it are so low that a vertex on the bump is
/// beyond them.
FarPatch low_patch(bool may_move) {
  constexpr double y_of[n] = {-2, -1, 0, 0.3, 2.3};
  FarPatch p;
  const auto id = [](Vec3i c) { return (c.x * n + c.y) * n + c.z; };
  Vec3i c;
  for (c.x = 0; c.x < n; ++c.x)
    for (c.y = 0; c.y < n; ++c.y)
      for (c.z = 0; c.z < n; ++c.z) {
        const bool inner = std::min({c.x, c.y, c.z}) > 0 && std::max({c.x, c.y, c.z}) < n - 1;
        p.position.push_back({c.x - 2., y_of[c.y], c.z - 2.});
        p.is_free.push_back(may_move && inner && c.y != 2);
      }
  constexpr int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (c.x = 0; c.x + 1 < n; ++c.x)
    for (c.y = 0; c.y + 1 < n; ++c.y)
      for (c.z = 0; c.z + 1 < n; ++c.z)
        for (const auto& axes : order) {
          Vec3i corner = c;
          Tet tet{id(c), 0, 0, 0};
          for (size_t i = 0; i < 3; ++i) {
            ++corner[axes[i]];
            tet[i + 1] = id(corner);
          }
          if (volume6(p, tet) < 0)
            std::swap(tet[2], tet[3]);
          const auto at = static_cast<int32_t>(p.element.size());
          p.element.push_back({at, tet, quality(p, tet), 1});
        }
  for (c.y = 2, c.x = 0; c.x + 1 < n; ++c.x)
    for (c.z = 0; c.z + 1 < n; ++c.z)
      for (const Vec3i side : {Vec3i{1, 0, 0}, Vec3i{0, 0, 1}}) {
        const auto at = static_cast<int32_t>(p.triangle.size());
        p.triangle.push_back({at, at, {id(c), id(c + side), id(c + Vec3i{1, 0, 1})}, 0});
        p.triangle.back().off = off(p, p.triangle.back().tri);
      }
  return p;
}

int64_t far(const FarPatch& p) {
  return std::count_if(p.triangle.begin(), p.triangle.end(),
                       [](const FarPatch::Triangle& t) { return t.off > contour::CentroidDistance::most; });
}
float worst(const FarPatch& p) {
  float least = 1;
  for (const FarPatch::Element& e : p.element)
    least = std::min(least, quality(p, e.tet));
  return least;
}

} // namespace

TEST_CASE("an edge that is divided and joined again leaves the patch as it was") {
  FarPatch p = ring_patch(true);
  const FarPatch before = p;
  const FarPatch::Edge edge = p.edge(0, 0);
  REQUIRE(edge.end == std::array<int32_t, 2>{0, 1});
  CHECK(edge.elements.size() == ring);
  CHECK(edge.triangles.size() == 2);
  REQUIRE(p.is_divisible(edge));

  const int32_t middle = p.divide(edge, {0, 0, 0.25});
  CHECK(middle == 2 + ring);
  REQUIRE(p.element.size() == 2 * ring);
  CHECK(p.triangle.size() == 4);
  CHECK(stars_hold(p));
  double sum = 0, was = 0;
  for (const FarPatch::Element& e : p.element) {
    CHECK(volume6(p, e.tet) > 0);
    sum += volume6(p, e.tet);
  }
  for (const FarPatch::Element& e : before.element)
    was += volume6(before, e.tet);
  CHECK(sum == Approx(was));
  for (size_t i = ring; i < p.element.size(); ++i)
    CHECK(p.element[i].at < 0);
  for (const size_t t : {2u, 3u}) {
    CHECK(p.triangle[t].at < 0);
    CHECK(p.triangle[t].parent == static_cast<int32_t>(t) - 2);
  }

  p.join(edge);
  CHECK(stars_hold(p));
  CHECK(p.position == before.position);
  REQUIRE(p.element.size() == before.element.size());
  for (size_t i = 0; i < p.element.size(); ++i)
    CHECK(p.element[i].tet == before.element[i].tet);
  REQUIRE(p.triangle.size() == before.triangle.size());
  for (size_t i = 0; i < p.triangle.size(); ++i)
    CHECK(p.triangle[i].tri == before.triangle[i].tri);
}

TEST_CASE("an edge whose ring is open lies on a wall and is not divided") {
  FarPatch p = ring_patch(false);
  CHECK_FALSE(p.is_divisible(p.edge(0, 0)));
}

TEST_CASE("a far edge is divided where points can make room for the new vertex") {
  FarPatch p = low_patch(true);
  const size_t positions = p.position.size();
  const float before = worst(p);
  REQUIRE(far(p) == 2);
  const int64_t divided = contour::FarDivision(p, Bump{}, goal, shape).run();
  CHECK(divided > 0);
  CHECK(p.position.size() == positions + static_cast<size_t>(divided));
  CHECK(far(p) == 0);
  CHECK(worst(p) >= std::min(goal, before));
  CHECK(stars_hold(p));
  for (const FarPatch::Element& e : p.element) {
    CHECK(volume6(p, e.tet) > 0);
    CHECK(e.quality == quality(p, e.tet));
  }
  for (const FarPatch::Triangle& t : p.triangle)
    CHECK(t.off == off(p, t.tri));
  for (size_t v = positions; v < p.position.size(); ++v)
    CHECK(std::fabs(Bump{}.distance(p.position[v])) <= 0.45);
}

TEST_CASE("where nothing can make room for a new vertex all stays as it is") {
  FarPatch p = low_patch(false);
  const FarPatch before = p;
  CHECK(contour::FarDivision(p, Bump{}, goal, shape).run() == 0);
  CHECK(p.position == before.position);
  REQUIRE(p.element.size() == before.element.size());
  for (size_t i = 0; i < p.element.size(); ++i) {
    CHECK(p.element[i].tet == before.element[i].tet);
    CHECK(p.element[i].quality == before.element[i].quality);
  }
  REQUIRE(p.triangle.size() == before.triangle.size());
  for (size_t i = 0; i < p.triangle.size(); ++i) {
    CHECK(p.triangle[i].tri == before.triangle[i].tri);
    CHECK(p.triangle[i].off == before.triangle[i].off);
  }
}
