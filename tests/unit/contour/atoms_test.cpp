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

TEST_CASE("a cylinder without atoms: volume and area converge to those of a cylinder with rounded edges") {
  const Vec3d axis = Vec3d{2, -1, 1.5} / norm(Vec3d{2, -1, 1.5});
  const double radius = 5, half = 6, skin = 1.7;
  Hierarchy h;
  h.atom.push_back({{0.31, -0.17, 0.23}, skin});
  h.body = {{Body::Shape::cylinder, h.atom[0].center, half * axis, {}, radius, skin, 0}};
  // Steiner's formula: of the core the volume, the area, and the integral of the mean curvature.
  const double r = radius - skin, l = 2 * (half - skin), s = skin;
  const double core = pi * r * r * l, face = 2 * pi * r * (l + r), bend = pi * l + pi * pi * r;
  const double volume = core + face * s + bend * s * s + 4. / 3 * pi * s * s * s,
               area = face + 2 * bend * s + 4 * pi * s * s;
  double before[2] = {1, 1};
  for (const double spacing : {1.2, 0.6, 0.3}) {
    CAPTURE(spacing);
    const Validity v = check_validity(mesh_of(h, spacing), 1);
    CHECK(v.valid());
    CHECK(v.surface.euler == 2);
    const double error[2] = {std::fabs(v.volume / volume - 1), std::fabs(v.surface.area / area - 1)};
    for (int i = 0; i < 2; ++i) {
      CHECK(error[i] < before[i] / 2.5);
      CHECK(error[i] < 0.045 * spacing * spacing);
      before[i] = error[i];
    }
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
