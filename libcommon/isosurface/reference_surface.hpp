// reference_surface.hpp — the input mesh's own surface, the target if there is no density.
#pragma once
#include "isosurface/target.hpp"
#include "mesh/tet_mesh.hpp"
#include <vector>

namespace molmesh {

/// Closest points on a set of triangles, found through hash grids. Memory O(triangles), whatever their sizes.
class ReferenceSurface final : public Target {
public:
  /// take [tris]: which triangles count. spacing() is a share of their mean edge, far longer ones left out.
  ReferenceSurface(const TetMesh& mesh, const std::vector<uint8_t>& take);
  bool project(Vec3d& p, double reach) const override;
  bool probe(Vec3d p, double& distance, Vec3d& normal) const override;
  double spacing() const override { return spacing_; }
  size_t entries() const { return entry_.size(); } ///< of the grids: 27 a triangle at most

private:
  struct Triangle {
    Vec3d a, b, c, normal;
  };
  bool closest(Vec3d p, double reach, Vec3d& point, int32_t& triangle) const;
  std::vector<Triangle> triangle_;
  double cell_ = 1, spacing_ = 1;
  uint64_t mask_ = 0, levels_ = 0; ///< levels: a bit each where there are triangles
  std::vector<int64_t> begin_;     ///< [buckets + 1]
  std::vector<int32_t> entry_;
  uint64_t bucket(uint64_t key) const { return (key ^ key >> 29) & mask_; }
};

} // namespace molmesh
