// distance_items.hpp — how far grid points are from the surface, and those too near moved away. Host and device.
#pragma once
#include "contour/detail/numbering_items.hpp"
#include "geom/log.hpp"
#include <cmath>

namespace molmesh::contour::detail {

/// Grid points nearer than this (in the edges of the smallest leaf round them) are moved away from the surface
/// along the gradient: slivers come from grid points next to it (Liang & Zhang, Engineering with Computers 2014).
inline constexpr double least_distance = 0.3;

/// Nearer than this (in fine spacings) the gradient at the grid point tells the distance better than the nearest
/// sample does.
inline constexpr double gradient_reach = 0.7;

/// Square of the gradient's part within a wall below which a grid point on it does not move.
inline constexpr double least_along = 0.5;

/// Of a grid point. near_surface: [grid vertices] corners of crossed leaves.
struct KeepDistance {
  ComplexView c;
  const uint8_t* near_surface;

  HD void operator()(int64_t i) const {
    const auto v = static_cast<int32_t>(i);
    c.distance[v] = c.estimate[v] = 0;
    c.has_moved[v] = 0;
    c.nearest[v] = -1;
    if (!near_surface[v])
      return;
    const int32_t least_extent = look_round(v);
    double d;
    Vec3d inwards;
    if (c.nearest[v] < 0 || !estimate(v, c.lattice.between(c.samples[c.nearest[v]].point), d, inwards))
      return;
    c.distance[v] = c.estimate[v] = static_cast<float>(d);
    const double least = (c.inside(v) ? 1 : -1) * least_distance * c.lattice.spacing * least_extent;
    if (std::fabs(d) >= std::fabs(least))
      return;
    for (int a = 0; a < 3; ++a) // walls stay plane
      if (c.point[v][a] == 0 || c.point[v][a] == c.lattice.cells[a])
        inwards[a] = 0;
    const double along = norm2(inwards);
    if (along < least_along)
      return;
    c.position[v] += (least - d) / along * inwards;
    c.distance[v] = static_cast<float>(least);
    c.has_moved[v] = 1;
  }

private:
  /// Nearest sample in the leaves with this corner, of two as near the first; returns the least of their extents.
  HD int32_t look_round(int32_t v) const {
    const Vec3i p = c.point[v];
    int32_t least_extent = 1 << 30, nearest = -1;
    float least_d2 = 3e38f;
    for (int octant = 0; octant < 8; ++octant) {
      const int32_t leaf = leaf_with_corner(c.tree, p, octant);
      if (leaf < 0)
        continue;
      const int32_t extent = c.tree.extent(leaf);
      least_extent = extent < least_extent ? extent : least_extent;
      if (c.side[leaf] != Side::crossed)
        continue;
      for (int32_t k = c.first_cell[leaf], end = c.end_cell(leaf); k < end; ++k) {
        const auto d2 = static_cast<float>(norm2(c.samples[k].point - to_double(p)));
        if (d2 < least_d2 || (d2 == least_d2 && k < nearest)) {
          least_d2 = d2;
          nearest = k;
        }
      }
    }
    c.nearest[v] = nearest;
    return least_extent;
  }

  /// d: distance to the surface (Å, positive inside); inwards: unit. foot: the nearest sample (Å).
  HD bool estimate(int32_t v, Vec3d foot, double& d, Vec3d& inwards) const {
    const Vec3i p = c.point[v];
    const double here = c.value[v];
    float there;
    if (here > 0 && c.lattice.active(p, there)) {
      // Gradient of log G, from whichever neighbours the band knows.
      Vec3d gradient;
      for (int a = 0; a < 3; ++a) {
        double sum = 0;
        int n = 0;
        for (int step = -1; step < 2; step += 2) {
          Vec3i q = p;
          q[a] += step;
          if (q[a] < 0 || q[a] > c.lattice.cells[a])
            continue;
          if (!c.lattice.active(q, there) || !(there > 0))
            continue;
          sum += portable_log(double(there) / here) / (c.lattice.position(q)[a] - c.lattice.position(p)[a]);
          ++n;
        }
        gradient[a] = n ? sum / n : 0;
      }
      if (const double slope = norm(gradient); slope > 0) {
        d = portable_log(here / c.lattice.isovalue) / slope;
        inwards = gradient / slope;
        if (std::fabs(d) <= gradient_reach * c.lattice.spacing)
          return true;
      }
    }
    const double sign = c.inside(v) ? 1 : -1;
    const Vec3d from = sign * (c.position[v] - foot);
    const double length = norm(from);
    if (!(length > 0))
      return false;
    d = sign * length;
    inwards = from / length;
    return true;
  }
};

/// Puts a moved grid point back where the lattice has it.
struct Restore {
  ComplexView c;
  const int32_t* vertex;
  HD void operator()(int64_t i) const {
    const int32_t v = vertex[i];
    c.position[v] = c.lattice.position(c.point[v]);
    c.distance[v] = c.estimate[v];
    c.has_moved[v] = 0;
  }
};

} // namespace molmesh::contour::detail
