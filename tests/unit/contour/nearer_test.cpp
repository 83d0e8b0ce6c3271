// nearer_test.cpp — surface triangles across creases are no farther from the isosurface than half a spacing.
#include "contour/contour.hpp"
#include "contour/relaxation/star_items.hpp"
#include "geom/tet_measures.hpp"
#include "isosurface/isosurface.hpp"
#include "unit/contour/sample_grid.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

using namespace molmesh;

namespace {

/// Spacings from the centroid to its foot on the isosurface, of the farthest surface triangle.
double farthest(const TetMesh& mesh, const Isosurface& isosurface) {
  double most = 0;
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    if (mesh.boundary[t] != surface)
      continue;
    Vec3d centroid;
    for (const int32_t v : mesh.tri[t])
      centroid += mesh.point[v] / 3.;
    Vec3d foot = centroid;
    if (isosurface.project(foot, 5 * isosurface.spacing()))
      most = std::max(most, norm(foot - centroid) / isosurface.spacing());
  }
  return most;
}

double least_angle(const TetMesh& mesh) {
  double least = 180;
  for (const Tet& t : mesh.tet) {
    const auto x = [&](size_t i) { return mesh.point[t[i]]; };
    const Dihedrals d = dihedrals(x(0), x(1), x(2), x(3));
    least = std::min(least, *std::min_element(d.degree, d.degree + 6));
  }
  return least;
}

} // namespace

TEST_CASE("surface triangles across creases come within half a spacing of the isosurface") {
  for (const unsigned seed : {2u, 4u, 8u, 11u, 14u, 20u}) {
    CAPTURE(seed);
    const BlockGrid grid = test::creased_grid(seed);
    contour::Options options;
    options.adapt = 0.41;
    contour::Summary summary;
    const TetMesh mesh = contour::contour(grid, options, summary, [](const std::string&) {});
    CHECK(farthest(mesh, Isosurface(grid, 1)) < 0.5);
    CHECK(least_angle(mesh) > 13);
  }
}

TEST_CASE("candidates without a triangle have an empty star, wherever they are") {
  const std::vector<int32_t> owner{1, 1, 4, 6};
  std::vector<int64_t> first(9 + 1, 4); // of nine candidates
  const contour::FirstOfStars item{owner.data(), first.data()};
  for (int64_t slot = 0; slot < 4; ++slot)
    item(slot);
  CHECK(first == std::vector<int64_t>{0, 0, 2, 2, 2, 3, 3, 4, 4, 4});
}
