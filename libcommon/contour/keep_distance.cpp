// keep_distance.cpp — grid points are kept a minimum distance away from the surface.
#include "contour/complex.hpp"
#include "contour/detail/at.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace molmesh::contour {

using detail::at;
namespace {

/// Grid points nearer than this (in the edges of the smallest leaf round them) are moved away from the surface
/// along the gradient: slivers come from grid points next to it (Liang & Zhang, Engineering with Computers 2014).
constexpr double least_distance = 0.3;

/// Nearer than this (in fine spacings) the gradient at the grid point tells the distance better than the nearest
/// sample does.
constexpr double gradient_reach = 0.7;

/// Square of the gradient's part within a wall below which a grid point on it does not move.
constexpr double least_along = 0.5;

} // namespace

/// d: distance to the surface (Å, positive inside); inwards: unit. foot: the nearest sample (Å).
bool Complex::estimate_distance(int32_t v, Vec3d foot, double& d, Vec3d& inwards) const {
  const Vec3i p = point[at(v)];
  const double here = value[at(v)];
  if (here > 0 && lattice.active(p)) {
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
    if (const double slope = norm(gradient); slope > 0) {
      d = std::log(here / lattice.isovalue) / slope;
      inwards = gradient / slope;
      if (std::fabs(d) <= gradient_reach * lattice.grid().frame.spacing)
        return true;
    }
  }
  const double sign = inside(v) ? 1 : -1;
  const Vec3d from = sign * (position[at(v)] - foot);
  const double length = norm(from);
  if (!(length > 0))
    return false;
  d = sign * length;
  inwards = from / length;
  return true;
}

void Complex::keep_distance(int threads) {
  distance.assign(at(grid_vertices), 0);
  moved_.assign(at(grid_vertices), 0);
  estimate_.assign(at(grid_vertices), 0);
  std::vector<int32_t> least_extent(at(grid_vertices), std::numeric_limits<int32_t>::max());
  nearest_.assign(at(grid_vertices), -1);
  std::vector<float> nearest_d2(at(grid_vertices), std::numeric_limits<float>::max());
  for (int32_t leaf = 0; leaf < tree.size(); ++leaf) {
    const bool crossed = side[at(leaf)] == Side::crossed;
    const int32_t end = crossed ? end_cell(leaf) : 0;
    for (int c = 0; c < 8; ++c) {
      const size_t v = at(grid_vertex[at(int64_t{8} * leaf + c)]);
      least_extent[v] = std::min(least_extent[v], tree.extent(leaf));
      for (int32_t k = first_cell[at(leaf)]; crossed && k < end; ++k) {
        const auto d2 = static_cast<float>(norm2(samples[at(k)].point - to_double(point[v])));
        if (d2 < nearest_d2[v]) {
          nearest_d2[v] = d2;
          nearest_[v] = k;
        }
      }
    }
  }
  const double h = lattice.grid().frame.spacing;
  par::for_n(grid_vertices, threads, [&](int64_t i) {
    const auto v = static_cast<int32_t>(i);
    double d;
    Vec3d inwards;
    if (nearest_[at(v)] < 0 ||
        !estimate_distance(v, lattice.between(samples[at(nearest_[at(v)])].point), d, inwards))
      return;
    distance[at(v)] = estimate_[at(v)] = static_cast<float>(d);
    const double least = (inside(v) ? 1 : -1) * least_distance * h * least_extent[at(v)];
    if (std::fabs(d) >= std::fabs(least))
      return;
    for (int a = 0; a < 3; ++a) // walls stay plane
      if (point[at(v)][a] == 0 || point[at(v)][a] == lattice.cells[a])
        inwards[a] = 0;
    const double along = norm2(inwards);
    if (along < least_along)
      return;
    position[at(v)] += (least - d) / along * inwards;
    distance[at(v)] = static_cast<float>(least);
    moved_[at(v)] = 1;
  });
}

std::vector<int32_t> Complex::restore(const std::vector<int32_t>& ids, int threads) {
  std::vector<uint8_t> flag(at(grid_vertices), 0);
  for (int32_t v : ids) {
    position[at(v)] = lattice.position(point[at(v)]);
    distance[at(v)] = estimate_[at(v)];
    moved_[at(v)] = 0;
    flag[at(v)] = 1;
  }
  std::vector<int32_t> leaves = leaves_at(flag, threads);
  par::for_n(static_cast<int64_t>(leaves.size()), threads, 64, [&](int64_t i) { place(leaves[at(i)]); });
  return leaves;
}

} // namespace molmesh::contour
