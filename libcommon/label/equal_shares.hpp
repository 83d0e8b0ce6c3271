// equal_shares.hpp — where two groups have equal shares, as an isosurface that interfaces are kept on.
#pragma once
#include "grid/block_grid.hpp"
#include "isosurface/isosurface.hpp"
#include "label/label.hpp"
#include "mesh/tet_mesh.hpp"
#include <array>
#include <map>
#include <vector>

namespace molmesh::label {

/// The share of `first` over that of `second` on the grid's points within `around` of the places (Å), isovalue 1:
/// larger in the first. Points where either is too small to be known are not active.
BlockGrid share_ratio(const ShareFinder& shares, int32_t first, int32_t second, const GridFrame& frame,
                      const std::vector<Vec3d>& near, double around, int threads);

struct Interface {
  std::array<int32_t, 2> group; ///< ascending
  std::vector<Vec3d> point;     ///< of its triangles
};
/// By label; what divide() has made.
std::map<int32_t, Interface> interfaces_of(const TetMesh& m);

/// Where the two shares are equal, near the interface: ln of their ratio is trilinear in cells of half the
/// density's spacing, which distances are measured in. The normal points out of the lower group.
class EqualShares final : public Target {
public:
  /// frame: the density's.
  EqualShares(const ShareFinder& shares, const Interface& interface, const GridFrame& frame, int threads);
  bool project(Vec3d& p, double reach) const override { return surface_.project(p, reach); }
  bool project_in_plane(Vec3d& p, int axis, double reach) const override {
    return surface_.project_in_plane(p, axis, reach);
  }
  bool probe(Vec3d p, double& distance, Vec3d& normal) const override {
    return surface_.probe(p, distance, normal);
  }
  void probe_eight(const EightPlaces& p, int n, EightProbes& out) const override {
    surface_.probe_eight(p, n, out);
  }
  uint32_t project_eight(EightPlaces& p, int n, double reach) const override {
    return surface_.project_eight(p, n, reach);
  }
  double spacing() const override { return spacing_; }

private:
  Isosurface surface_;
  double spacing_;
};

} // namespace molmesh::label
