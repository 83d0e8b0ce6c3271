// isosurface.hpp — G = isovalue on a block grid, with log G trilinear in each cell.
// Where G is exponential log G is nearly quadratic: its interpolant is closer to the field than G's.
#pragma once
#include "grid/block_grid.hpp"
#include "isosurface/isosurface_view.hpp"
#include "isosurface/target.hpp"

namespace molmesh {

/// Known on cells whose eight corners are active. Keeps no reference to the grid.
class Isosurface final : public Target {
public:
  Isosurface(const BlockGrid& grid, int threads);
  bool project(Vec3d& p, double reach) const override { return view().project(p, reach); }
  bool project_in_plane(Vec3d& p, int axis, double reach) const override;
  bool probe(Vec3d p, double& distance, Vec3d& normal) const override { return view().probe(p, distance, normal); }
  void probe_eight(const EightPlaces& p, int n, EightProbes& out) const override {
    molmesh::probe_eight(view(), p, n, out);
  }
  uint32_t project_eight(EightPlaces& p, int n, double reach) const override {
    return molmesh::project_eight(view(), p, n, reach);
  }
  /// Of up to four grid points next to each other, with all around them on the other side.
  bool pocket(Vec3d p, bool hole, Vec3d& inside) const override;
  /// Within two spacings on each axis of the grid point next to p.
  bool neck(Vec3d p, Neck& neck) const override;
  double spacing() const override { return frame_.spacing; }
  /// As IsosurfaceView::evaluate.
  bool evaluate(Vec3d p, double& f, Vec3d& gradient) const { return view().evaluate(p, f, gradient); }
  IsosurfaceView view() const { return {frame_, index_.view(), log_.data(), offset_}; }
  /// Points are projected this far outside the isosurface (Å), so that chords enclose the isosurface's own volume.
  void set_offset(double offset) { offset_ = offset; }
  double offset() const override { return offset_; }

  int64_t values() const { return static_cast<int64_t>(log_.size()); } ///< of view().log
  int64_t slots() const { return index_.capacity(); }                  ///< of view().index

private:
  GridFrame frame_;
  BlockIndex index_;
  LargeArray<float> log_; ///< [512 n], NaN where not active
  double offset_ = 0;
};

} // namespace molmesh
