// plan_test.cpp — a mesh is as large as its plan says.
#include "contour/contour.hpp"
#include "contour/plan.hpp"
#include "density/density.hpp"
#include "unit/contour/sample_grid.hpp"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <random>

using namespace molmesh;

namespace {

/// Atoms of 1.7 Å at random in a ball.
BlockGrid ball_of_atoms(double spacing, double radius = 9, size_t atoms = 150) {
  Hierarchy h;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(-radius, radius);
  while (h.atom.size() < atoms) {
    const Vec3d p{at(random), at(random), at(random)};
    if (norm2(p) < radius * radius) {
      Atom a;
      a.center = p;
      a.radius = 1.7;
      h.atom.push_back(a);
    }
  }
  density::Options o;
  o.spacing = spacing;
  density::Counts counts;
  return to_block_grid(density::compute(h, o, counts), 1);
}

} // namespace

TEST_CASE("the octree tells the elements of a mesh within 15 %, and its triangles") {
  for (const double spacing : {0.5, 0.8}) {
    const BlockGrid grid = ball_of_atoms(spacing);
    for (const auto meshed : {contour::Options::interior, contour::Options::exterior, contour::Options::both}) {
      contour::Options options;
      options.meshed = meshed;
      contour::Summary summary;
      const TetMesh mesh = contour::contour(grid, options, summary, [](const std::string&) {});
      const auto true_elements = double(mesh.tet.size()), true_triangles = double(mesh.tri.size());
      const contour::Leaves leaves = contour::count_leaves(grid, options);
      const contour::Plan plan = contour::plan(leaves, std::ssize(grid.corner), meshed);
      CAPTURE(spacing, int(meshed), plan.elements, true_elements);
      CHECK(std::abs(double(plan.elements) - true_elements) <= 0.15 * true_elements);
      CHECK(std::abs(double(plan.triangles) - true_triangles) <= 0.25 * true_triangles);
      CHECK(leaves.split == double(summary.split_cells));
    }
  }
}

TEST_CASE("where a coarse grid has many split cells the plan knows of their elements") {
  const BlockGrid grid = ball_of_atoms(2.5, 20, 1000);
  for (const auto meshed : {contour::Options::interior, contour::Options::exterior, contour::Options::both}) {
    contour::Options options;
    options.meshed = meshed;
    contour::Summary summary;
    const TetMesh mesh = contour::contour(grid, options, summary, [](const std::string&) {});
    const contour::Leaves leaves = contour::count_leaves(grid, options);
    REQUIRE(leaves.split > 0.1 * leaves.surface);
    CAPTURE(int(meshed), mesh.tet.size());
    CHECK(double(contour::plan(leaves, 0, meshed).elements) == Approx(double(mesh.tet.size())).epsilon(0.15));
  }
}

TEST_CASE("the volume that a grid shows of a ball is that of a ball smaller by h²/4r, halved or not") {
  constexpr double r = 3.3;
  for (const double h : {0.1, 0.25, 0.5, 1.0, 1.5}) {
    const BlockGrid grid = test::cube_grid(6, h, [](Vec3d x) { return std::exp(r * r - norm2(x)); });
    contour::Options options;
    const double volume = contour::LeafCounter(grid, options).volume();
    const double shown = r - h * h / (4 * r);
    CAPTURE(h, volume);
    CHECK(volume == Approx(4. / 3 * 3.14159265 * shown * shown * shown).epsilon(0.02));
    options.threads = 3;
    CHECK(contour::LeafCounter(grid, options).volume() == volume);
  }
}

TEST_CASE("a device makes large meshes sooner, and its start costs more than a small one") {
  const auto is_sooner = [](double leaves, int threads) {
    return contour::is_sooner_on_device(contour::plan({leaves, leaves / 2, 0}, 100, contour::Options::both),
                                        threads);
  };
  for (const int threads : {1, 2, 16}) {
    CAPTURE(threads);
    CHECK_FALSE(is_sooner(1e3, threads));
    CHECK(is_sooner(3e6, threads));
  }
  CHECK(is_sooner(1e5, 1));
  CHECK_FALSE(is_sooner(1e5, 16));
}

TEST_CASE("a coarser grid has fewer leaves, and the way back is the same") {
  const contour::Leaves fine{1000, 550, 0};
  double before = 1001;
  for (const double spacing : {0.5, 0.6, 1.0, 1.7, 4.0, 9.0}) {
    const contour::Leaves coarse = contour::at_spacing(fine, 0.5, spacing);
    CHECK(coarse.all < before);
    CHECK(coarse.inside <= coarse.all);
    before = coarse.all;
    CHECK(contour::at_spacing(coarse, spacing, 0.5).all == Approx(1000));
  }
}
