// surface_error.cpp — projects each centroid, and adds up in a fixed order.
#include "contour/surface_distance/surface_error.hpp"
#include "contour/surface_distance/nearer_items.hpp"
#include "geom/tet_measures.hpp"
#include "isosurface/isosurface.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace molmesh::contour {
namespace {

struct Sum {
  double worst = 0, squares = 0, area = 0;
};

/// Å; p's foot, or nothing where it is not found.
std::optional<double> to_foot(const IsosurfaceView& view, Vec3d p) {
  Vec3d foot = p;
  if (!view.project(foot, CentroidDistance::beyond * view.spacing()))
    return {};
  return norm(foot - p);
}

/// Of the middle of a triangle. Its foot may be on another piece of the surface than the nearest, or not be found:
/// by way of a corner it is not nearer than it is.
double off(const IsosurfaceView& view, Vec3d middle, const std::array<Vec3d, 3>& corners) {
  double least = to_foot(view, middle).value_or(1e300);
  if (least > CentroidDistance::sure * view.spacing())
    for (const Vec3d& c : corners)
      least = std::min(least, norm(c - middle) + to_foot(view, c).value_or(view.spacing()));
  return least;
}

} // namespace

SurfaceError surface_error(const TetMesh& mesh, const BlockGrid& grid, int threads) {
  const Isosurface isosurface(grid, threads);
  const IsosurfaceView view = isosurface.view();
  const Sum all = par::reduce(
      std::ssize(mesh.tri), threads, Sum{},
      [&](int64_t i) {
        if (mesh.boundary[static_cast<size_t>(i)] != surface)
          return Sum{};
        const Tri& t = mesh.tri[static_cast<size_t>(i)];
        const Vec3d a = mesh.point[t[0]], b = mesh.point[t[1]], d = mesh.point[t[2]];
        const double distance = off(view, (a + b + d) / 3., {a, b, d}), area = tri_area(a, b, d);
        return Sum{distance, area * distance * distance, area};
      },
      [](const Sum& a, const Sum& b) {
        return Sum{std::max(a.worst, b.worst), a.squares + b.squares, a.area + b.area};
      });
  return {all.worst, all.area > 0 ? std::sqrt(all.squares / all.area) : 0};
}

} // namespace molmesh::contour
