// edge_crossing.hpp — where the surface crosses a sign-change edge of the complex. Host and device.
#pragma once
#include "contour/complex/complex.hpp"
#include <cmath>

namespace molmesh::contour {

MOLMESH_HD inline double kept_off_ends(double share) {
  constexpr double least = 0.02; // of an edge between its end and a crossing
  return share < least ? least : share > 1 - least ? 1 - least : share;
}

/// On a coarse edge whose ends have moved: the distances to the surface say about where, the tangent plane at the
/// nearer of the ends' nearest samples more exactly.
MOLMESH_HD inline Vec3d moved_crossing(const ComplexView& c, int32_t a, int32_t b) {
  const Vec3d pa = c.position[a], along = c.position[b] - pa;
  const double da = c.distance[a], db = c.distance[b];
  double share = da != 0 && db != 0 ? da / (da - db) : 0.5;
  const Vec3d x = pa + share * along;
  int32_t nearest = -1;
  for (int end = 0; end < 2; ++end)
    if (const int32_t k = c.nearest[end ? b : a]; k >= 0)
      if (nearest < 0 ||
          norm2(c.lattice.between(c.samples[k].point) - x) < norm2(c.lattice.between(c.samples[nearest].point) - x))
        nearest = k;
  if (nearest >= 0) {
    const SurfaceSample s = c.samples[nearest];
    if (const double slope = dot(along, s.normal); std::fabs(slope) > 0.3 * norm(along))
      share = dot(c.lattice.between(s.point) - pa, s.normal) / slope;
  }
  return pa + kept_off_ends(share) * along;
}

/// Between two vertices on opposite sides, Å. Coarse edges whose ends have not moved are searched on the fine grid.
MOLMESH_HD_CALL inline Vec3d crossing(const ComplexView& c, int32_t a, int32_t b) {
  Vec3d pa = c.position[a], pb = c.position[b];
  float va = c.value[a], vb = c.value[b];
  if (a < c.grid_vertices && b < c.grid_vertices) {
    Vec3i qa = c.point[a], qb = c.point[b];
    const auto length = [&] {
      const Vec3i d = qa - qb;
      const int32_t x = d.x < 0 ? -d.x : d.x, y = d.y < 0 ? -d.y : d.y, z = d.z < 0 ? -d.z : d.z;
      return x > y ? (x > z ? x : z) : (y > z ? y : z);
    };
    if (length() > 1 && (c.moved(a) || c.moved(b)))
      return moved_crossing(c, a, b);
    const bool in = c.inside(a);
    while (length() > 1) { // one sign change along the edge: halve
      const Vec3i middle{(qa.x + qb.x) / 2, (qa.y + qb.y) / 2, (qa.z + qb.z) / 2};
      const float v = c.lattice.value(middle);
      ((v > c.lattice.isovalue) == in ? qa : qb) = middle;
      ((v > c.lattice.isovalue) == in ? va : vb) = v;
    }
    if (qa == c.point[a] && qb == c.point[b]) {
      const double da = c.distance[a], db = c.distance[b];
      if (da != 0 && db != 0)
        return pa + kept_off_ends(da / (da - db)) * (pb - pa);
    } else {
      pa = c.lattice.position(qa);
      pb = c.lattice.position(qb);
    }
  }
  return pa + crossing_share(va, vb, c.lattice.isovalue) * (pb - pa);
}

} // namespace molmesh::contour
