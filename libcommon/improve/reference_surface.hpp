// reference_surface.hpp — the surface that came in, as a target when there is no density.
#pragma once
#include "improve/target.hpp"
#include "mesh/tet_mesh.hpp"
#include <vector>

namespace molmesh::improve {

/// Closest points on a set of triangles, found through a hash grid.
class ReferenceSurface final : public Target {
public:
  /// take [tris]: which triangles count. spacing() is a share of their mean edge.
  ReferenceSurface(const TetMesh& mesh, const std::vector<uint8_t>& take);
  bool project(Vec3d& p, double reach) const override;
  bool probe(Vec3d p, double& distance, Vec3d& normal) const override;
  double spacing() const override { return spacing_; }

private:
  struct Triangle {
    Vec3d a, b, c, normal;
  };
  bool closest(Vec3d p, double reach, Vec3d& point, int32_t& triangle) const;
  std::vector<Triangle> triangle_;
  double cell_ = 1, spacing_ = 1;
  uint64_t mask_ = 0;
  std::vector<int64_t> begin_; ///< [buckets + 1]
  std::vector<int32_t> entry_;
  uint64_t bucket(int64_t x, int64_t y, int64_t z) const;
};

} // namespace molmesh::improve
