// convergence_test.cpp — a finer spacing is a finer mesh by default: more elements, and a surface nearer to the
// field's.
#include "contour/contour.hpp"
#include "density/density.hpp"
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace molmesh;

namespace {

/// A plain sum of atoms of 1.7 Å at random in a ball of 6 Å.
std::vector<Vec3d> ball_of_centers() {
  std::vector<Vec3d> center;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> at(-6, 6);
  while (center.size() < 60) {
    const Vec3d p{at(random), at(random), at(random)};
    if (norm2(p) < 36)
      center.push_back(p);
  }
  return center;
}

/// Distance from the isosurface, to first order: |ln G| / |∇ ln G|.
double distance(const std::vector<Vec3d>& center, Vec3d p) {
  double sum = 0;
  Vec3d gradient{0, 0, 0};
  for (const Vec3d& c : center) {
    const double term = std::exp(1.7 * 1.7 - norm2(p - c));
    sum += term;
    gradient -= 2 * term * (p - c);
  }
  return std::abs(std::log(sum)) / norm(gradient / sum);
}

} // namespace

// A grid that is too coarse for a small body is halved (small_bodies/): where that ends, elements may become fewer
// from one spacing to a little less.
TEST_CASE(
    "by default, the surface's error falls with the spacing and half of it makes more elements, below 0.5 Å too") {
  const std::vector<Vec3d> center = ball_of_centers();
  Hierarchy h;
  for (const Vec3d& c : center)
    h.atom.push_back({c, 1.7});
  std::vector<size_t> elements;
  double error_before = 1e300;
  for (const double spacing : {0.7, 0.5, 0.35, 0.25, 0.18}) {
    density::Options o;
    o.spacing = spacing;
    density::Counts counts;
    contour::Options options;
    contour::Summary summary;
    const TetMesh mesh = contour::contour(to_block_grid(density::compute(h, o, counts), 1), options, summary,
                                          [](const std::string&) {});
    double error = 0;
    for (const Tri& t : mesh.tri)
      error += distance(center, (mesh.point[t[0]] + mesh.point[t[1]] + mesh.point[t[2]]) / 3.0);
    error /= static_cast<double>(mesh.tri.size());
    CAPTURE(spacing, mesh.tet.size(), error, summary.adapt);
    elements.push_back(mesh.tet.size());
    CHECK(error < error_before);
    error_before = error;
  }
  for (size_t i = 2; i < elements.size(); ++i) // spacings fall by the square root of 2
    CHECK(elements[i] > elements[i - 2]);
}

TEST_CASE("the default tolerance falls with the spacing below 0.5 Å, and is as it was from there on") {
  for (const double spacing : {0.5, 0.7, 1.0, 2.0, 3.0})
    CHECK(contour::default_adapt(spacing) == std::max(0.1, 0.2 / spacing));
  for (const double spacing : {0.49, 0.35, 0.25, 0.1, 1e-3})
    CHECK(contour::default_adapt(spacing) == 0.4);
}
