// cluster_tree.cpp — nanoflann over the middles of the clusters' boxes.
#include "density/culling/cluster_tree.hpp"
#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace molmesh::density {
namespace {

struct Middles {
  const Field& f;
  size_t kdtree_get_point_count() const { return f.box.size(); }
  double kdtree_get_pt(size_t c, size_t axis) const {
    const int a = static_cast<int>(axis);
    return 0.5 * (f.box[c].lo[a] + f.box[c].hi[a]);
  }
  template <class B>
  bool kdtree_get_bbox(B&) const {
    return false;
  }
};

} // namespace

struct ClusterTree::Tree {
  Middles middles;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Middles>, Middles, 3> index;
  explicit Tree(const Field& f) : middles{f}, index(3, middles) {}
};

ClusterTree::ClusterTree(const Field& f) : f_(f), tree_(std::make_unique<Tree>(f)) {
  for (size_t c = 0; c < f.box.size(); ++c)
    reach_ = std::max(reach_, std::sqrt(f.cutoff2[c]) + 0.5 * norm(f.box[c].hi - f.box[c].lo));
}

ClusterTree::~ClusterTree() = default;

std::vector<int32_t> ClusterTree::near(const Box& box) const {
  const Vec3d middle = 0.5 * (box.lo + box.hi);
  const double point[3] = {middle.x, middle.y, middle.z};
  const double radius = reach_ + 0.5 * norm(box.hi - box.lo);
  std::vector<std::pair<uint32_t, double>> found;
  nanoflann::SearchParams unsorted;
  unsorted.sorted = false;
  tree_->index.radiusSearch(point, 1.000001 * radius * radius, found, unsorted);
  std::vector<int32_t> cluster;
  for (const auto& [c, d2] : found)
    if (distance2(box, f_.box[c]) < f_.cutoff2[c])
      cluster.push_back(static_cast<int32_t>(c));
  std::sort(cluster.begin(), cluster.end());
  return cluster;
}

} // namespace molmesh::density
