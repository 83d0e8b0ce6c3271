// cluster_tree.hpp — a kd-tree over the clusters of a field: the paper's search structure (§3.2 of Liao et al.
// 2013).
#pragma once
#include "density/field/field.hpp"
#include <memory>

namespace molmesh::density {

/// Keeps a reference to the field.
class ClusterTree {
public:
  explicit ClusterTree(const Field& f);
  ~ClusterTree();
  /// Ascending, the clusters nearer to `box` (Å) than their cutoff. From any thread.
  std::vector<int32_t> near(const Box& box) const;

private:
  struct Tree;
  const Field& f_;
  double reach_ = 0; ///< Å, the farthest a cluster's middle can be from a point that it matters to
  std::unique_ptr<Tree> tree_;
};

} // namespace molmesh::density
