// atoms_test.cpp — from atoms to a mesh, where the surface is known exactly.
#include "contour/contour.hpp"
#include "density/density.hpp"
#include "mesh/validity.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;

namespace {

constexpr double pi = 3.14159265358979323846;

TetMesh mesh_of(const Hierarchy& h, double spacing) {
  density::Options options;
  options.spacing = spacing;
  density::Counts counts;
  const BlockGrid grid = to_block_grid(density::compute(h, options, counts), 1);
  contour::Options contour_options;
  contour_options.adapt = 0;
  contour::Summary summary;
  return contour::contour(grid, contour_options, summary, [](const std::string&) {});
}

/// Largest distance of a surface point from the zero of `distance` (Å).
template <class F>
double worst_surface_point(const TetMesh& mesh, F distance) {
  double worst = 0;
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    if (mesh.boundary[t] == surface)
      for (int32_t v : mesh.tri[t])
        worst = std::max(worst, std::fabs(distance(mesh.point[v])));
  return worst;
}

} // namespace

TEST_CASE("one atom: volume, area and every surface point converge to the sphere") {
  Hierarchy h;
  h.atom.push_back({{0.31, -0.17, 0.23}, 2.0});
  const double volume = 4. / 3 * pi * 8, area = 4 * pi * 4;
  for (double spacing : {0.8, 0.4, 0.2, 0.1}) {
    CAPTURE(spacing);
    const TetMesh mesh = mesh_of(h, spacing);
    const Validity v = check_validity(mesh, 1);
    CHECK(v.valid());
    CHECK(v.surface.euler == 2);
    // Second order: the mean of a cell's crossings and the chords lie within h²/r of the sphere.
    const double order = spacing * spacing / 2.0;
    CHECK(worst_surface_point(mesh, [&](Vec3d x) { return norm(x - h.atom[0].center) - 2; }) < order);
    CHECK(std::fabs(v.volume / volume - 1) < order);
    CHECK(std::fabs(v.surface.area / area - 1) < order);
  }
}

TEST_CASE("two atoms: the volume is that of the known body of revolution, apart, touching and merged") {
  // On the axis through both, G = exp(-ρ²) A(z): the surface is ρ² = log A(z).
  for (double half : {0.7, 1.4, 3.0}) {
    CAPTURE(half);
    Hierarchy h;
    h.atom.push_back({{0, 0.1, half}, 1.7});
    h.atom.push_back({{0, 0.1, -half}, 1.7});
    double volume = 0;
    constexpr double step = 1e-4;
    for (double z = -half - 3; z < half + 3; z += step) {
      const double a =
          std::exp(1.7 * 1.7) * (std::exp(-(z - half) * (z - half)) + std::exp(-(z + half) * (z + half)));
      volume += pi * std::max(0.0, std::log(a)) * step;
    }
    double error[2];
    int n = 0;
    for (double spacing : {0.2, 0.1}) { // coarser cells are halved: finer_grid.hpp
      const Validity v = check_validity(mesh_of(h, spacing), 1);
      CHECK(v.valid());
      CHECK(v.surface.components == (half > 2 ? 2 : 1));
      CHECK(v.surface.euler == (half > 2 ? 4 : 2));
      error[n++] = std::fabs(v.volume / volume - 1);
    }
    CHECK(error[0] < 0.02);
    CHECK(error[1] < error[0] / 3);
  }
}
