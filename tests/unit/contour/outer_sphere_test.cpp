// outer_sphere_test.cpp — meshes that end at a sphere: validity, volume, points on it, the least radius, threads.
#include "base/error.hpp"
#include "contour/contour.hpp"
#include "contour/outer_sphere/cut_to_sphere.hpp"
#include "contour/outer_sphere/outer_sphere.hpp"
#include "contour/plan.hpp"
#include "mesh/quality.hpp"
#include "unit/contour/checked.hpp"
#include "unit/contour/sample_grid.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>

using namespace molmesh;
using namespace molmesh::test;
using contour::BoxRequest;
using contour::Options;

namespace {

constexpr double pi = 3.14159265358979323846;

Options in_sphere(Options::Meshed meshed, const Sphere& sphere) {
  Options options;
  options.meshed = meshed;
  options.box.kind = BoxRequest::sphere;
  options.box.outer = sphere;
  return options;
}

double area_of_sphere(const TetMesh& m) {
  double area = 0;
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] == Boundary::outer_sphere)
      area += 0.5 *
              norm(cross(m.point[m.tri[t][1]] - m.point[m.tri[t][0]], m.point[m.tri[t][2]] - m.point[m.tri[t][0]]));
  return area;
}

/// No triangle lies deeper below the sphere than this share of its longest edge, by its own plane.
double deepest(const TetMesh& m) {
  double most = 0;
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] == Boundary::outer_sphere) {
      const Vec3d a = m.point[m.tri[t][0]], b = m.point[m.tri[t][1]], c = m.point[m.tri[t][2]];
      const Vec3d n = cross(b - a, c - a);
      const double plane = dot(n, a - m.sphere->center) / norm(n);
      most = std::max(most, (m.sphere->radius - plane) / std::max({norm(b - a), norm(c - a), norm(c - b)}));
    }
  return most;
}

/// The molecule's and the sphere's own triangles and nothing else; every point of the mesh within the sphere.
void check_sphere(const TetMesh& m, const Sphere& sphere) {
  REQUIRE(m.sphere);
  CHECK(m.sphere->center == sphere.center);
  CHECK(m.sphere->radius == sphere.radius);
  std::vector<uint8_t> on(m.point.size(), 0);
  for (size_t t = 0; t < m.tri.size(); ++t) {
    REQUIRE((m.boundary[t] == Boundary::surface || m.boundary[t] == Boundary::outer_sphere));
    for (const int32_t v : m.tri[t])
      if (m.boundary[t] == Boundary::outer_sphere)
        on[v] = 1;
  }
  double off = 0, above = 0;
  for (size_t v = 0; v < m.point.size(); ++v) {
    const double height = sphere.height(m.point[v]);
    off = std::max(off, on[v] ? std::fabs(height) : 0);
    above = std::max(above, height);
  }
  CHECK(off < 4e-15 * (norm(sphere.center) + sphere.radius));
  CHECK(above < 4e-15 * (norm(sphere.center) + sphere.radius));
}

/// Of the outer boundary alone: one closed surface without handles, by counting.
int64_t euler_of_sphere(const TetMesh& m) {
  std::vector<std::array<int32_t, 2>> edge;
  std::vector<int32_t> point;
  int64_t triangles = 0;
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] == Boundary::outer_sphere) {
      ++triangles;
      for (size_t i = 0; i < 3; ++i) {
        const int32_t v = m.tri[t][i], w = m.tri[t][(i + 1) % 3];
        point.push_back(v);
        edge.push_back({std::min(v, w), std::max(v, w)});
      }
    }
  const auto distinct = [](auto& v) {
    std::sort(v.begin(), v.end());
    return std::unique(v.begin(), v.end()) - v.begin();
  };
  return distinct(point) - distinct(edge) + triangles;
}

} // namespace

TEST_CASE(
    "a ball within a sphere: valid, its points on the sphere, volume and area those of the sphere's triangles",
    "[slow]") {
  for (const Sphere& sphere : {Sphere{{0, 0, 0}, 6}, Sphere{{0.7, -1.3, 0.4}, 9}, Sphere{{2, 3, -1}, 60}})
    for (const auto meshed : {Options::exterior, Options::both}) {
      const double h = sphere.radius == 9 ? 0.25 : 0.5;
      CAPTURE(h, sphere.radius, int(meshed));
      const BlockGrid grid = cube_grid(6, h, atom);
      const TetMesh mesh = mesh_of(grid, in_sphere(meshed, sphere));
      const Validity v = checked(mesh);
      check_sphere(mesh, sphere);
      CHECK(euler_of_sphere(mesh) == 2);
      CHECK(v.surface.components == 1);
      const double whole = 4 * pi / 3 * std::pow(sphere.radius, 3), ball = 36 * pi;
      const double volume = meshed == Options::both ? v.volume : v.volume + ball;
      CHECK(volume < whole * (meshed == Options::both ? 1 : 1 + 3e-3)); // of the ball at this spacing
      CHECK(volume > 0.985 * whole);
      const double area = area_of_sphere(mesh);
      CHECK(area < 4 * pi * sphere.radius * sphere.radius);
      CHECK(area > 0.985 * 4 * pi * sphere.radius * sphere.radius);
      CHECK(deepest(mesh) < 0.1);
      const Distribution angle = measure_quality(mesh, 1).all.dihedral;
      CHECK(angle.min > 8);
      CHECK(angle.max < 165);
    }
}

TEST_CASE("cells beside a large sphere are as coarse as far cells are") {
  const BlockGrid grid = cube_grid(6, 0.25, atom);
  Options box;
  box.meshed = Options::exterior;
  box.box.kind = BoxRequest::factor;
  box.box.scale = 2;
  const size_t near = mesh_of(grid, box).tet.size();
  size_t before = 0;
  for (const double radius : {6., 24., 96., 384.}) {
    const size_t tets = mesh_of(grid, in_sphere(Options::exterior, {{0, 0, 0}, radius})).tet.size();
    CAPTURE(radius, tets, near);
    CHECK(tets <
          near + 120000); // an eighth of the radius: some 2,000 cells and their balance, not more with the radius
    CHECK((before == 0 || tets < before + 60000));
    before = tets;
  }
}

TEST_CASE("the sphere round the surface is that of a ball, and its factor and padding are taken of its radius") {
  const auto moved = [](Vec3d x) { return atom(x - Vec3d{0.13, -0.21, 0.37}); };
  const BlockGrid grid = cube_grid(6, 0.25, moved);
  const Sphere s = contour::sphere_round_surface(grid, 1);
  CHECK(norm(s.center - Vec3d{0.13, -0.21, 0.37}) < 0.02);
  CHECK(s.radius == Approx(3).epsilon(0.01));
  BoxRequest request;
  request.kind = BoxRequest::sphere_factor;
  request.scale = 2.5;
  CHECK(contour::with_sphere(grid, request, 1).outer.radius == 2.5 * s.radius);
  request.kind = BoxRequest::sphere_padding;
  request.distance = 7;
  const BoxRequest padded = contour::with_sphere(grid, request, 2);
  CHECK(padded.kind == BoxRequest::sphere);
  CHECK(padded.outer.radius == s.radius + 7);
  CHECK(padded.outer.center == s.center);
  CHECK(contour::with_sphere(grid, padded, 1).outer.radius == padded.outer.radius);
}

TEST_CASE("a sphere that meets the surface is refused with a radius that works", "[slow]") {
  const BlockGrid grid = cube_grid(6, 0.5, atom);
  for (const Vec3d center : {Vec3d{0, 0, 0}, Vec3d{1.1, 0.3, -0.2}, Vec3d{9, 4, 2}})
    for (const double radius : {center.x > 0 && center.x < 5 ? 0.4 : norm(center) + 3.2}) {
      CAPTURE(center.x, radius);
      std::string line;
      try {
        mesh_of(grid, in_sphere(Options::both, {center, radius}));
      } catch (const Error& e) {
        CHECK(e.status == Status::failed);
        CHECK(e.quantities == std::vector<std::string>{"box"});
        line = e.what();
      }
      const std::string mark = "expected a radius of at least ";
      const size_t at = line.find(mark);
      REQUIRE(at != std::string::npos);
      const double least = std::strtod(line.c_str() + at + mark.size(), nullptr);
      CHECK(least > norm(center) + 3);
      CHECK(least < norm(center) + 8);
      const TetMesh mesh = mesh_of(grid, in_sphere(Options::both, {center, least}));
      checked(mesh);
      check_sphere(mesh, {center, least});
    }
}

TEST_CASE("the same mesh within a sphere on any number of threads", "[slow]") {
  const BlockGrid grid = creased_grid(3);
  Options options;
  options.meshed = Options::both;
  options.box.kind = BoxRequest::sphere_factor;
  options.box.scale = 1.7;
  const TetMesh one = mesh_of(grid, options);
  checked(one);
  for (const int threads : {3}) {
    options.threads = threads;
    const TetMesh mesh = mesh_of(grid, options);
    REQUIRE(mesh.point.size() == one.point.size());
    CHECK(std::memcmp(mesh.point.data(), one.point.data(), one.point.size() * sizeof(Vec3d)) == 0);
    CHECK(std::equal(mesh.tet.begin(), mesh.tet.end(), one.tet.begin(), one.tet.end()));
    CHECK(mesh.tri == one.tri);
    CHECK(mesh.boundary == one.boundary);
    CHECK(mesh.region == one.region);
    CHECK(mesh.sphere->radius == one.sphere->radius);
  }
}

TEST_CASE("spheres at random places and of random radii cut a mesh validly") {
  const BlockGrid grid = cube_grid(4.5, 0.5, atom);
  Options options;
  options.meshed = Options::both;
  options.box.kind = BoxRequest::corners;
  options.box.lower = {-13, -14, -15};
  options.box.upper = {15, 14, 13};
  const TetMesh whole = mesh_of(grid, options);
  std::mt19937_64 random(50);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int trial = 0; trial < 60; ++trial) {
    // On grid points and half-way between them too, where points are on the sphere already.
    Vec3d center{u(random), u(random), u(random)};
    double radius = 9 + 2 * u(random);
    if (trial % 3 == 0)
      center = {0.5 * std::round(2 * center.x), 0.5 * std::round(2 * center.y), 0.5 * std::round(2 * center.z)},
      radius = std::round(radius);
    CAPTURE(trial, center.x, center.y, center.z, radius);
    TetMesh mesh = whole;
    contour::cut_to_sphere(mesh, {center, radius}, 1);
    checked(mesh);
    check_sphere(mesh, {center, radius});
    CHECK(euler_of_sphere(mesh) == 2);
  }
}

TEST_CASE("a plan counts what is within the sphere") {
  const BlockGrid grid = creased_grid(5);
  Options options;
  options.meshed = Options::both;
  options.box.kind = BoxRequest::sphere_factor;
  options.box.scale = 2;
  const contour::Leaves leaves = contour::count_leaves(grid, options);
  const auto elements = double(contour::plan(leaves, int64_t(grid.corner.size()), Options::both).elements);
  const auto made = double(mesh_of(grid, options).tet.size());
  CHECK(elements > 0.85 * made);
  CHECK(elements < 1.15 * made);
}
