// fit_test.cpp — meshes of at most so many elements, and what they cost in distance from the isosurface.
#include "contour/fit.hpp"
#include "contour/surface_distance/surface_error.hpp"
#include "unit/contour/checked.hpp"
#include "unit/contour/sample_grid.hpp"
#include <catch2/catch.hpp>
#include <set>

using namespace molmesh;
using namespace molmesh::test;
using namespace molmesh::contour;

namespace {

/// Three balls that overlap, some 20 spacings long.
BlockGrid balls(double spacing = 0.3) {
  return cube_grid(8.5, spacing, [](Vec3d x) {
    double sum = 0;
    for (const Vec3d c : {Vec3d{-2, 0.3, 0}, Vec3d{2, 0, 0.2}, Vec3d{0.1, 3, 0}})
      sum += std::exp(-0.6 * (norm2(x - c) - 4));
    return sum;
  });
}

TetMesh fitted(const BlockGrid& grid, const Options& options, int64_t most, Fit& fit) {
  return fitted_mesh(
      LeafCounter(grid, options), grid, options, most, [&](const Options& with) { return mesh_of(grid, with); },
      fit);
}

Options of(Options::Meshed meshed, int threads = 1) {
  Options options;
  options.meshed = meshed;
  options.threads = threads;
  return options;
}

} // namespace

TEST_CASE("a fitted mesh has at most so many elements, and 0.7 of them, by its tolerance or by layers") {
  const BlockGrid grid = balls();
  std::set<int> layers;
  for (const int64_t most : {28'000, 36'000, 45'000}) {
    Fit fit;
    const TetMesh mesh = fitted(grid, of(Options::interior), most, fit);
    CAPTURE(most, fit.fineness.adapt, fit.fineness.layers);
    CHECK(std::ssize(mesh.tet) <= most);
    CHECK(10 * std::ssize(mesh.tet) >= 7 * most);
    CHECK(fit.elements == double(mesh.tet.size()));
    checked(mesh);
    layers.insert(fit.fineness.layers);
  }
  CHECK(layers.size() > 1);
}

TEST_CASE("a fitted mesh of both sides, or of the surroundings, is the same for any number of threads") {
  const BlockGrid grid = balls(0.4);
  for (const auto meshed : {Options::both, Options::exterior}) {
    Fit one, three;
    const TetMesh a = fitted(grid, of(meshed, 1), 60'000, one), b = fitted(grid, of(meshed, 3), 60'000, three);
    CHECK(10 * std::ssize(a.tet) >= 7 * 60'000);
    CHECK(std::ssize(a.tet) <= 60'000);
    CHECK(one.fineness.adapt == three.fineness.adapt);
    CHECK(one.fineness.layers == three.fineness.layers);
    CHECK((a.point.size() == b.point.size() && std::equal(a.point.begin(), a.point.end(), b.point.begin())));
    CHECK((a.tet.size() == b.tet.size() && std::equal(a.tet.begin(), a.tet.end(), b.tet.begin())));
    checked(a);
  }
}

TEST_CASE("fewer elements than the coarsest octree has are not to be had, and more than the finest end there") {
  const BlockGrid grid = balls(0.4);
  Fit fit;
  CHECK(fitted(grid, of(Options::interior), 2'000, fit).tet.empty());
  CHECK(fit.coarsest);
  CHECK(fit.elements > 2'000);
  Options uniform = of(Options::interior);
  uniform.adapt = 0;
  const auto most = std::ssize(mesh_of(grid, uniform).tet);
  const TetMesh finest = fitted(grid, of(Options::interior), 10 * most, fit);
  CHECK(fit.finest);
  CHECK(std::ssize(finest.tet) > 9 * most / 10);
}

TEST_CASE("the surface's error of a ball is that of its triangles' centroids") {
  constexpr double radius = 3; // log G is quadratic: its interpolant is less than 0.008 off
  const BlockGrid grid = cube_grid(6, 0.25, atom);
  Options options = of(Options::interior);
  options.adapt = 0.4;
  const TetMesh mesh = mesh_of(grid, options);
  double worst = 0, squares = 0, area = 0;
  for (const Tri& t : mesh.tri) {
    const Vec3d a = mesh.point[t[0]], b = mesh.point[t[1]], c = mesh.point[t[2]];
    const double off = std::fabs(norm((a + b + c) / 3.) - radius), here = 0.5 * norm(cross(b - a, c - a));
    worst = std::max(worst, off);
    squares += here * off * off;
    area += here;
  }
  const SurfaceError error = surface_error(mesh, grid, 2), alone = surface_error(mesh, grid, 1);
  CHECK(error.worst == Approx(worst).margin(0.009));
  CHECK(error.rms == Approx(std::sqrt(squares / area)).margin(0.004));
  CHECK(error.worst > 0.05);
  CHECK(error.worst == alone.worst);
  CHECK(error.rms == alone.rms);
}
