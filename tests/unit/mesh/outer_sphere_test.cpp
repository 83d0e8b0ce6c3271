// outer_sphere_test.cpp — rules of a mesh that ends at a sphere, each kept and broken; spheres found from points.
#include "mesh/adjacency.hpp"
#include "mesh/fitted_sphere.hpp"
#include "mesh/validity.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

using namespace molmesh;
namespace {

constexpr double pi = 3.14159265358979323846;

/// The triangles anew, all of the sphere; outer ones point out.
void label_all(TetMesh& m, const Sphere& s) {
  rebuild_triangles(m);
  m.boundary.assign(m.tri.size(), Boundary::outer_sphere);
  for (Tri& t : m.tri)
    if (std::find(t.begin(), t.end(), 0) == t.end() &&
        dot(cross(m.point[t[1]] - m.point[t[0]], m.point[t[2]] - m.point[t[0]]), m.point[t[0]] - s.center) < 0)
      std::swap(t[1], t[2]);
}

/// Eight tetrahedra between the middle and the octants of a sphere.
TetMesh octahedron(const Sphere& s) {
  TetMesh m;
  m.point.push_back(s.center);
  for (int a = 0; a < 3; ++a)
    for (const double way : {-1., 1.}) {
      Vec3d d;
      d[a] = way;
      m.point.push_back(s.nearest(s.center + d));
    }
  for (int32_t octant = 0; octant < 8; ++octant) {
    Tet t{0, 1 + (octant & 1), 3 + (octant >> 1 & 1), 5 + (octant >> 2 & 1)};
    if (dot(cross(m.point[t[1]] - s.center, m.point[t[2]] - s.center), m.point[t[3]] - s.center) < 0)
      std::swap(t[2], t[3]);
    m.tet.push_back(t);
  }
  m.region.assign(8, Region::outside);
  label_all(m, s);
  m.sphere = s;
  return m;
}

std::vector<std::string> broken(const TetMesh& m) {
  std::vector<std::string> rules;
  for (const Fault& f : check_validity(m, 1).faults)
    rules.push_back(f.rule);
  return rules;
}

} // namespace

TEST_CASE("points of the outer sphere are on it, its triangles are the only outer ones") {
  const Sphere s{{3, -70, 11}, 40};
  TetMesh m = octahedron(s);
  const Validity v = check_validity(m, 1);
  CHECK(v.faults.empty());
  REQUIRE(v.outer_sphere);
  CHECK(v.outer_sphere->triangles == 8);
  CHECK(v.outer_sphere->area == Approx(8 * std::sqrt(3.) / 2 * 1600));
  CHECK(v.outer_sphere->volume == Approx(4. / 3 * 64000));
  CHECK(v.outer_sphere->euler == 2);

  SECTION("a point off the sphere by more than rounding") {
    m.point[2].x += 1e-10;
    CHECK(broken(m) == std::vector<std::string>{"sphere_point"});
  }
  SECTION("a triangle of a box") {
    m.boundary[3] = Boundary::box_y1;
    CHECK(broken(m) == std::vector<std::string>{"sphere_label"});
  }
  SECTION("a triangle between two tetrahedra") {
    m.region[5] = Region::cavity;
    label_all(m, s);
    CHECK(broken(m) == std::vector<std::string>{"sphere_label", "sphere_point"});
  }
  SECTION("without the sphere the triangles are no box's") {
    m.sphere.reset();
    CHECK(broken(m) == std::vector<std::string>{"box_plane"});
    CHECK(!check_validity(m, 1).outer_sphere);
  }
}

TEST_CASE("the sphere through points is found to rounding, and none where they are on none") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> n;
  for (const Sphere& s : {Sphere{{0, 0, 0}, 1}, Sphere{{120, -35, 7.7}, 93.1}, Sphere{{-1e4, 3, 0}, 0.5}}) {
    std::vector<Vec3d> point;
    for (int i = 0; i < 400; ++i) {
      Vec3d d;
      for (int a = 0; a < 3; ++a)
        d[a] = n(random);
      point.push_back(s.nearest(s.center + d));
    }
    std::vector<int32_t> on(point.size());
    std::iota(on.begin(), on.end(), 0);
    const std::optional<Sphere> found = sphere_through(point, on);
    REQUIRE(found);
    CHECK(norm(found->center - s.center) <= s.rounding());
    CHECK(std::fabs(found->radius - s.radius) <= s.rounding());
    point[17] += Vec3d{1e-6, 0, 0};
    point[18] += Vec3d{0, 1e-6, 1e-6};
    CHECK(!sphere_through(point, on));
    on.resize(3);
    CHECK(!sphere_through(point, on));
  }
  // All in one plane: many spheres.
  std::vector<Vec3d> circle;
  std::vector<int32_t> on;
  for (int i = 0; i < 12; ++i) {
    circle.push_back({std::cos(2 * pi * i / 12), std::sin(2 * pi * i / 12), 0});
    on.push_back(i);
  }
  CHECK(!sphere_through(circle, on));
}
