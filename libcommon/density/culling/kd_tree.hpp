// kd_tree.hpp — a kd-tree over the clusters of atoms finds those near a box or a brick (§3.2 of Liao et al. 2013).
// Each cluster has a cutoff distance of its own (R_kd of equation 7, field/cutoff.hpp).
#pragma once
#include "density/culling/bricks.hpp"
#include <memory>

namespace molmesh::density {

/// Keeps a reference to the field.
class KdTree {
public:
  explicit KdTree(const Field& f);
  ~KdTree();
  /// Ascending, the clusters nearer to `box` (Å) than their cutoff. From any thread.
  std::vector<int32_t> near(const Box& box) const;

private:
  struct Tree;
  const Field& f_;
  double reach_ = 0; ///< Å, the farthest the middle of a cluster of atoms can be from a point that it matters to
  std::unique_ptr<Tree> tree_;
};

/// As bricks_by_bvh(), by a kd-tree that is asked once for each brick near a cluster.
BrickList bricks_by_kd_tree(const Field& f, const GridFrame& frame, const BlockRange& range, bool every,
                            int threads);

} // namespace molmesh::density
