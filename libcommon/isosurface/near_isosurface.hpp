// near_isosurface.hpp — probes the isosurface at many points close to each other.
#pragma once
#include "isosurface/probe_simd.hpp"

namespace molmesh {

/// IsosurfaceView::probe, to the last bit; remembers the cells it was asked in, one of each parity. For one thread.
class NearIsosurface {
public:
  explicit NearIsosurface(const IsosurfaceView& view) : view_(view) {}
  double spacing() const { return view_.spacing(); }

  bool probe(Vec3d p, double& distance, Vec3d& normal) const {
    Vec3d u, gradient;
    Vec3i c;
    if (!view_.locate(p, u, c))
      return false;
    Cell& cell = cell_[(c.x & 1) | (c.y & 1) << 1 | (c.z & 1) << 2];
    if (!cell.known || !(cell.corner == c)) {
      cell.corner = c;
      cell.known = view_.values(c, cell.value);
      if (!cell.known)
        return view_.probe(p, distance, normal);
    }
    double f;
    view_.interpolate(u, c, cell.value, f, gradient);
    return view_.to_distance(f, gradient, distance, normal);
  }

  bool project(Vec3d& p, double reach) const { return view_.project(p, reach); }
  void probe_eight(const EightPlaces& p, int n, EightProbes& out) const { molmesh::probe_eight(view_, p, n, out); }

private:
  struct Cell {
    bool known = false;
    Vec3i corner;
    double value[8];
  };
  const IsosurfaceView& view_;
  mutable Cell cell_[8];
};

} // namespace molmesh
