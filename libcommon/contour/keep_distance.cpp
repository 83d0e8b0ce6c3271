// keep_distance.cpp — grid points are kept a minimum distance away from the surface.
#include "contour/complex.hpp"
#include "contour/detail/at.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::contour {

using detail::at;
namespace {

/// Grid points nearer than this (in spacings) are moved away from the surface
/// along the gradient: slivers come from grid points next to it (Liang & Zhang, Engineering with Computers 2014).
constexpr double least_distance = 0.3;

} // namespace

void Complex::keep_distance(int threads) {
  distance.assign(at(grid_vertices), 0);
  moved_.assign(at(grid_vertices), 0);
  estimate_.assign(at(grid_vertices), 0);
  // Of the surface cells' grid points only those with eight fine cells round them move: the centre of a larger cell
  // looks past its smaller neighbours' grid points by no margin.
  std::vector<uint8_t> fine(at(grid_vertices), 0), near(at(grid_vertices), 0);
  for (int32_t leaf = 0; leaf < tree.size(); ++leaf) {
    for (int c = 0; c < 8; ++c) {
      const size_t v = at(grid_vertex[at(int64_t{8} * leaf + c)]);
      fine[v] = static_cast<uint8_t>(fine[v] + (tree.level[at(leaf)] == 0));
      near[v] = near[v] || side[at(leaf)] == Side::crossed;
    }
  }
  const double h = lattice.grid().frame.spacing;
  par::for_n(grid_vertices, threads, [&](int64_t v) {
    if (!near[at(v)])
      return;
    const Vec3i p = point[at(v)];
    const double here = value[at(v)];
    if (!(here > 0) || !lattice.active(p))
      return;
    // Gradient of log G, from whichever neighbours the band knows.
    Vec3d gradient;
    for (int a = 0; a < 3; ++a) {
      double sum = 0;
      int n = 0;
      for (int step : {-1, 1}) {
        Vec3i q = p;
        q[a] += step;
        if (q[a] < 0 || q[a] > lattice.cells[a])
          continue;
        const double there = lattice.value(q);
        if (!(there > 0) || !lattice.active(q))
          continue;
        sum += std::log(there / here) / (lattice.position(q)[a] - lattice.position(p)[a]);
        ++n;
      }
      gradient[a] = n ? sum / n : 0;
    }
    const double slope = norm(gradient);
    if (!(slope > 0))
      return;
    const double d = std::log(here / lattice.isovalue) / slope, least = least_distance * h;
    distance[at(v)] = static_cast<float>(d);
    if (std::fabs(d) >= least || fine[at(v)] != 8)
      return;
    const bool in = inside(static_cast<int32_t>(v));
    position[at(v)] += ((in ? least : -least) - d) / slope * gradient;
    distance[at(v)] = static_cast<float>(in ? least : -least);
    moved_[at(v)] = 1;
    estimate_[at(v)] = static_cast<float>(d);
  });
}

void Complex::restore(const std::vector<int32_t>& ids, int threads) {
  for (int32_t v : ids) {
    position[at(v)] = lattice.position(point[at(v)]);
    distance[at(v)] = estimate_[at(v)];
    moved_[at(v)] = 0;
  }
  position.resize(at(grid_vertices + tree.size()));
  value.resize(at(grid_vertices + tree.size()));
  place_duals(threads);
}

} // namespace molmesh::contour
