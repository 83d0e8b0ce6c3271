// outer_sphere.cpp — center and radius from the surface's crossings with the grid's edges.
#include "contour/outer_sphere/outer_sphere.hpp"
#include "base/error.hpp"
#include "contour/surface/surface_cell.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::contour {
namespace {

/// f(x) at every crossing of the surface with the grid's edges at the points of block b, Å.
template <class F>
void for_crossings(const BlockGrid& grid, const BlockIndex& index, int64_t b, F&& f) {
  const auto isovalue = static_cast<float>(grid.info.isovalue);
  for (int s = 0; s < 512; ++s) {
    const float value = grid.value[512 * b + s];
    if (!(value > isovalue) || !(grid.active[8 * b + (s >> 6)] >> (s & 63) & 1))
      continue;
    const Vec3i p = grid.corner[b] + within_block(s);
    for (int way = 0; way < 6; ++way) {
      Vec3i step;
      step[way / 2] = way % 2 == 0 ? -1 : 1;
      if (const float beyond = value_at(grid, index, p + step); !(beyond > isovalue))
        f(grid.frame.position(p) +
          (grid.frame.spacing * crossing_share(value, beyond, isovalue)) * to_double(step));
    }
  }
}

} // namespace

Sphere sphere_round_surface(const BlockGrid& grid, int threads) {
  const BlockIndex index(grid);
  const auto blocks = static_cast<int64_t>(grid.corner.size());
  struct Extent {
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  };
  const Extent all = par::reduce(
      blocks, threads, Extent(),
      [&](int64_t b) {
        Extent e;
        for_crossings(grid, index, b, [&](Vec3d x) {
          for (int a = 0; a < 3; ++a)
            e.low[a] = std::min(e.low[a], x[a]), e.high[a] = std::max(e.high[a], x[a]);
        });
        return e;
      },
      [](Extent e, const Extent& other) {
        for (int a = 0; a < 3; ++a)
          e.low[a] = std::min(e.low[a], other.low[a]), e.high[a] = std::max(e.high[a], other.high[a]);
        return e;
      },
      64);
  if (all.low.x > all.high.x)
    fail(Status::failed,
         "the density has no surface at isovalue " + std::to_string(grid.info.isovalue) + ": nothing to mesh");
  Sphere sphere{0.5 * (all.low + all.high), 0};
  sphere.radius = par::reduce(
      blocks, threads, 0.,
      [&](int64_t b) {
        double farthest = 0;
        for_crossings(grid, index, b, [&](Vec3d x) { farthest = std::max(farthest, norm(x - sphere.center)); });
        return farthest;
      },
      [](double a, double b) { return std::max(a, b); }, 64);
  return sphere;
}

BoxRequest with_sphere(const BlockGrid& grid, BoxRequest request, int threads) {
  if (request.kind != BoxRequest::sphere_factor && request.kind != BoxRequest::sphere_padding)
    return request;
  request.outer = sphere_round_surface(grid, threads);
  request.outer.radius = request.kind == BoxRequest::sphere_factor ? request.scale * request.outer.radius
                                                                   : request.outer.radius + request.distance;
  request.kind = BoxRequest::sphere;
  return request;
}

} // namespace molmesh::contour
