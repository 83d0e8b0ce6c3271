// distance_items.hpp — kernels that estimate how far grid points are from the surface and move those too near away.
// Host and device.
#pragma once
#include "base/log.hpp"
#include "contour/complex/complex.hpp"
#include "par/atomic_updates.hpp"
#include <bit>
#include <cmath>

namespace molmesh::contour {

/// Grid points nearer than this (in the edges of the smallest leaf round them) are moved away from the surface
/// along the gradient: slivers come from grid points next to it (Liang & Zhang, Engineering with Computers 2014).
inline constexpr double least_distance = 0.3;

/// Nearer than this (in fine spacings) the gradient at the grid point tells the distance better than the nearest
/// sample does.
inline constexpr double gradient_reach = 0.7;

/// Square of the gradient's component within a wall below which a grid point on it does not move.
inline constexpr double least_along = 0.5;

/// Of the leaves round each grid point, from the leaves' side: the nearest of their samples, of two as near the
/// first, and their least level.
struct LookFromLeaf {
  /// The square of the distance as a float, then the sample.
  static constexpr uint64_t none = ~uint64_t{0};
  ComplexView c;
  uint64_t* nearest; ///< [grid vertices] none at first
  uint32_t* level;   ///< [grid vertices] large at first

  MOLMESH_HD void operator()(int64_t i) const {
    const auto leaf = static_cast<int32_t>(i);
    for (int k = 0; k < 8; ++k)
      par::lower(level[c.corner_vertex(leaf, k)], uint32_t{c.tree.level[leaf]});
    if (c.side[leaf] == Side::crossed)
      find_nearest(leaf);
  }

private:
  MOLMESH_HD void find_nearest(int32_t leaf) const {
    const Vec3d low = to_double(c.tree.corner(leaf));
    const double extent = c.tree.extent(leaf);
    float least[8];
    int32_t sample[8];
    for (int k = 0; k < 8; ++k)
      least[k] = 3e38f;
    for (int32_t s = c.first_cell[leaf], end = c.end_cell(leaf); s < end; ++s) {
      const Vec3d from_low = c.samples[s].point - low,
                  from_high = c.samples[s].point - (low + Vec3d{extent, extent, extent});
      const double x[2] = {from_low.x * from_low.x, from_high.x * from_high.x},
                   y[2] = {from_low.y * from_low.y, from_high.y * from_high.y},
                   z[2] = {from_low.z * from_low.z, from_high.z * from_high.z};
      for (int k = 0; k < 8; ++k) {
        const auto d2 = static_cast<float>(x[k & 1] + y[k >> 1 & 1] + z[k >> 2]);
        sample[k] = d2 < least[k] ? s : sample[k];
        least[k] = d2 < least[k] ? d2 : least[k];
      }
    }
    for (int k = 0; k < 8; ++k)
      par::lower(nearest[c.corner_vertex(leaf, k)],
                 uint64_t{std::bit_cast<uint32_t>(least[k])} << 32 | static_cast<uint32_t>(sample[k]));
  }
};

/// Of a grid point, after LookFromLeaf.
struct KeepDistance {
  ComplexView c;
  const uint64_t* nearest;
  const uint32_t* level;

  MOLMESH_HD void operator()(int64_t i) const {
    const auto v = static_cast<int32_t>(i);
    c.distance[v] = c.estimate[v] = 0;
    c.has_moved[v] = 0;
    c.nearest[v] = -1;
    c.least_level[v] = static_cast<uint8_t>(level[v]);
    if (nearest[v] == LookFromLeaf::none)
      return;
    c.nearest[v] = static_cast<int32_t>(nearest[v] & 0xFFFFFFFF);
    const int32_t least_extent = 1 << level[v];
    double d;
    Vec3d inwards;
    if (!estimate(v, c.lattice.between(c.samples[c.nearest[v]].point), d, inwards))
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
  /// d: distance to the surface (Å, positive inside); inwards: unit. foot: the nearest sample (Å).
  MOLMESH_HD bool estimate(int32_t v, Vec3d foot, double& d, Vec3d& inwards) const {
    const Vec3i p = c.point[v];
    const double here = c.value[v];
    float there;
    BlockIndexView::Last home;
    if (here > 0 && c.lattice.active(p, there, home)) {
#ifndef __CUDA_ARCH__
      for (const int step : {-64, -8, 8, 64}) // they are fetched while the index is searched for the first
        if (const int64_t near = 512 * home.block + slot(c.lattice.base + p) + step; near >= 0)
          __builtin_prefetch(c.lattice.grid + near);
#endif
      // Gradient of log G, from whichever neighbours the band knows: two an axis.
      bool known[6];
      double log[8];
      for (int k = 0; k < 6; ++k) {
        Vec3i q = p;
        q[k / 2] += k % 2 ? 1 : -1;
        BlockIndexView::Last last = home;
        known[k] =
            q[k / 2] >= 0 && q[k / 2] <= c.lattice.cells[k / 2] && c.lattice.active(q, there, last) && there > 0;
        log[k] = known[k] ? double(there) / here : 1;
      }
      log[6] = log[7] = here / c.lattice.isovalue;
      for (double& of : log) // some at once
        portable_logs<double, uint64_t>(double{of}, of);
      Vec3d gradient;
      for (int a = 0; a < 3; ++a) {
        double sum = 0;
        for (int side = 0; side < 2; ++side)
          if (known[2 * a + side])
            sum += log[2 * a + side] / (c.lattice.axis[a][p[a] + (side ? 1 : -1)] - c.lattice.axis[a][p[a]]);
        const int n = known[2 * a] + known[2 * a + 1];
        gradient[a] = n ? sum / n : 0;
      }
      if (const double slope = norm(gradient); slope > 0) {
        d = log[6] / slope;
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
  MOLMESH_HD void operator()(int64_t i) const {
    const int32_t v = vertex[i];
    c.position[v] = c.lattice.position(c.point[v]);
    c.distance[v] = c.estimate[v];
    c.has_moved[v] = 0;
  }
};

} // namespace molmesh::contour
