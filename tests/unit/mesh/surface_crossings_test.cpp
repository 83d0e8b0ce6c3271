// surface_crossings_test.cpp — pairs of triangles in known positions, and the tree against all pairs.
#include "geom/intersect.hpp"
#include "mesh/surface_crossings.hpp"
#include "mesh/validity.hpp"
#include "meshes.hpp"
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;
using namespace molmesh::testing;

namespace {

/// Triangle 0 1 2 is (0,0,0) (4,0,0) (0,4,0); the other has these corners, in any order.
bool cross(Vec3d a, Vec3d b, Vec3d c) {
  const std::vector<Vec3d> point{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, a, b, c};
  std::array<int32_t, 3> other{3, 4, 5};
  for (int32_t& v : other) // equal places are common corners
    for (int32_t w = 0; w < 3; ++w)
      if (point[v] == point[w])
        v = w;
  bool first = false;
  for (int turn = 0; turn < 6; ++turn) {
    const bool found = triangles_cross(point, {0, 1, 2}, other);
    CHECK(triangles_cross(point, other, {1, 2, 0}) == found);
    if (turn == 0)
      first = found;
    CHECK(found == first);
    std::rotate(other.begin(), other.begin() + 1, other.end());
    if (turn == 2)
      std::swap(other[0], other[1]);
  }
  return first;
}

} // namespace

TEST_CASE("triangles apart, touching, through one another") {
  CHECK_FALSE(cross({0, 0, 1}, {4, 0, 1}, {0, 4, 1}));
  CHECK(cross({1, 1, -1}, {1, 1, 1}, {2, 1, 1}));
  CHECK(cross({1, 1, 0}, {1, 1, 1}, {2, 1, 1}));                          // a corner on the other
  CHECK_FALSE(cross({1, 1, std::nextafter(0, 1)}, {1, 1, 1}, {2, 1, 1})); // just above it
  CHECK(cross({2, -1, -1}, {2, -1, 1}, {2, 0, 0}));                       // a corner on an edge
  CHECK_FALSE(cross({5, 5, -1}, {5, 5, 1}, {6, 5, 0}));
}

TEST_CASE("triangles meet where an edge of one meets the other") {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> at(0, 3); // many lie in one plane, on one line or in one place
  for (int n = 0; n < 20000; ++n) {
    std::vector<Vec3d> point(6);
    for (Vec3d& p : point)
      p = {double(at(random)), double(at(random)), double(at(random))};
    const auto meets = [&](int32_t a, int32_t b, std::array<int32_t, 3> t) {
      return segment_meets_triangle(point[size_t(a)], point[size_t(b)], point[size_t(t[0])], point[size_t(t[1])],
                                    point[size_t(t[2])]);
    };
    const std::array<int32_t, 3> s{0, 1, 2}, apart{3, 4, 5}, at_corner{0, 3, 4};
    CHECK(triangles_cross(point, s, apart) == (meets(0, 1, apart) || meets(1, 2, apart) || meets(2, 0, apart) ||
                                               meets(3, 4, s) || meets(4, 5, s) || meets(5, 3, s)));
    CHECK(triangles_cross(point, s, at_corner) == (meets(1, 2, at_corner) || meets(3, 4, s)));
  }
}

TEST_CASE("triangles in one plane") {
  CHECK(cross({1, 1, 0}, {2, 1, 0}, {1, 2, 0}));       // inside
  CHECK(cross({-9, -9, 0}, {20, -9, 0}, {-9, 20, 0})); // around
  CHECK(cross({1, -1, 0}, {3, -1, 0}, {2, 1, 0}));     // across an edge
  CHECK_FALSE(cross({5, 5, 0}, {6, 5, 0}, {5, 6, 0}));
  CHECK(cross({4.5, 0, 0}, {3, 0, 0}, {4, -2, 0})); // along an edge
}

TEST_CASE("triangles with a common corner or edge") {
  CHECK_FALSE(cross({0, 0, 0}, {-1, 0, 0}, {0, -1, 0}));
  CHECK_FALSE(cross({0, 0, 0}, {1, 1, 1}, {1, 2, 1}));
  CHECK(cross({0, 0, 0}, {1, 1, -1}, {1, 1, 1}));
  CHECK(cross({0, 0, 0}, {1, 1, 0}, {1, 2, 0}));                          // in the plane, over it
  CHECK_FALSE(cross({0, 0, 0}, {4, 0, 0}, {0, -4, 0}));                   // an edge, flat
  CHECK_FALSE(cross({0, 0, 0}, {4, 0, 0}, {0, 4, std::nextafter(0, 1)})); // nearly folded
  CHECK(cross({0, 0, 0}, {4, 0, 0}, {1, 1, 0}));                          // folded
  CHECK_FALSE(cross({4, 0, 0}, {0, 0, 0}, {0, 4, 0}));                    // the same triangle
}

TEST_CASE("the tree finds the pairs that all pairs show") {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> u(0, 1);
  for (int n : {0, 1, 2, 9, 300}) {
    std::vector<Vec3d> point;
    std::vector<Tri> tri;
    for (int i = 0; i < n; ++i) {
      const Vec3d at{u(random), u(random), u(random)};
      const auto v = static_cast<int32_t>(point.size());
      for (int k = 0; k < 3; ++k)
        point.push_back(at + 0.6 * Vec3d{u(random), u(random), u(random)});
      tri.push_back({v, v + 1, v + 2});
    }
    Crossings expected;
    for (int32_t s = 0; s < n; ++s)
      for (int32_t t = s + 1; t < n; ++t)
        if (triangles_cross(point, tri[s], tri[t]) && expected.pairs++ == 0)
          expected.first = {s, t};
    for (int threads : {1, 2, 5}) {
      const Crossings found = find_crossings(point, tri, threads);
      CHECK(found.pairs == expected.pairs);
      CHECK(found.first == expected.first);
    }
    CHECK((n < 300 || expected.pairs > 100));
  }
}

TEST_CASE("add_crossings leaves the box sides out, and names the triangles of the mesh") {
  TetMesh m = cubes(5, [](Vec3i c) -> int32_t { return c == Vec3i{1, 1, 1} || c == Vec3i{3, 3, 3} ? 1 : 2; });
  Validity both = check_validity(m, 1);
  add_crossings(both, m, 1);
  CHECK(both.valid());
  TetMesh apart = extract(m, [](int32_t r) { return r == 1; });
  for (Vec3d& p : apart.point)
    if (p.x >= 2.5)
      p += Vec3d{-1.6, -1.6, -1.6};
  Validity v = check_validity(apart, 1);
  CHECK(v.valid()); // no local rule sees it
  add_crossings(v, apart, 1);
  REQUIRE(v.faults.size() == 1);
  CHECK(v.faults[0].rule == "crossing_triangles");
}
