// reference_surface.hpp — the input mesh's own surface, the target if there is no density.
#pragma once
#include "isosurface/target.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/tet_mesh.hpp"
#include <atomic>
#include <memory>
#include <vector>

namespace molmesh {

/// Closest points on a set of triangles, found through a tree of their boxes. Where over a thousand are about as
/// near it may be a point of another one of these.
class ReferenceSurface final : public Target {
public:
  /// take [tris]: which triangles count. spacing() is a share of their mean edge, far longer ones left out.
  ReferenceSurface(const TetMesh& mesh, const std::vector<uint8_t>& take);
  bool project(Vec3d& p, double reach) const override;
  bool probe(Vec3d p, double& distance, Vec3d& normal) const override;
  double spacing() const override { return spacing_; }
  int64_t looks() const override { return looks_; }

private:
  struct Triangle {
    Vec3d a, b, c, normal;
    int32_t index; ///< in the mesh: of equally near ones the first counts
  };
  struct Answer;
  static Answer& kept_answer(Vec3d p, double reach);
  void sort_along_curve();
  const Triangle* closest(Vec3d p, double reach, Vec3d& point, int& looked_at) const;
  std::vector<Triangle> triangle_; ///< along a curve that keeps near ones together
  std::unique_ptr<BoxTree> tree_;
  uint64_t number_ = 0;                    ///< of this surface among all
  mutable std::atomic<bool> many_ = false; ///< many triangles were looked at for a closest point
  double edge_ = 1, spacing_ = 1;          ///< typical length of an edge, Å
  int64_t looks_ = 8;
};

} // namespace molmesh
