// kd_tree.cpp — indexes the middles of the clusters' boxes with nanoflann.
#include "density/culling/kd_tree.hpp"
#include "par/par.hpp"
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

struct KdTree::Tree {
  Middles middles;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Middles>, Middles, 3> index;
  explicit Tree(const Field& f) : middles{f}, index(3, middles) {}
};

KdTree::KdTree(const Field& f) : f_(f), tree_(std::make_unique<Tree>(f)) {
  for (size_t c = 0; c < f.box.size(); ++c)
    if (f.body_of(static_cast<int64_t>(c)) < 0)
      reach_ = std::max(reach_, std::sqrt(f.cutoff2[c]) + 0.5 * norm(f.box[c].hi - f.box[c].lo));
}

KdTree::~KdTree() = default;

std::vector<int32_t> KdTree::near(const Box& box) const {
  const Vec3d middle = 0.5 * (box.lo + box.hi);
  const double point[3] = {middle.x, middle.y, middle.z};
  const double radius = reach_ + 0.5 * norm(box.hi - box.lo);
  std::vector<std::pair<uint32_t, double>> found;
  nanoflann::SearchParams unsorted;
  unsorted.sorted = false;
  tree_->index.radiusSearch(point, 1.000001 * radius * radius, found, unsorted);
  std::vector<int32_t> cluster;
  for (const auto& [c, d2] : found)
    if (distance2(box, f_.box[c]) < f_.cutoff2[c] && f_.body_of(c) < 0)
      cluster.push_back(static_cast<int32_t>(c));
  for (const FieldBody& b : f_.body) // large, so that no middle tells
    if (distance2(box, f_.box[b.cluster]) < f_.cutoff2[b.cluster])
      cluster.push_back(static_cast<int32_t>(b.cluster));
  std::sort(cluster.begin(), cluster.end());
  return cluster;
}

BrickList bricks_by_kd_tree(const Field& f, const GridFrame& frame, const BlockRange& range, bool every,
                            int threads) {
  const KdTree tree(f);
  struct Asked {
    Vec3i corner;
    std::vector<int32_t> near;
  };
  std::vector<Asked> asked;
  constexpr int32_t together = 4 * brick_blocks; // of a cube that has any, the tree is asked for every brick
  const auto descend = [&](auto&& self, Vec3i corner, int32_t blocks) -> void {
    if (!range.meets(corner, blocks) ||
        (!every && blocks >= together && tree.near(points_box(frame, corner, blocks)).empty()))
      return;
    if (blocks == brick_blocks)
      return asked.push_back({corner, {}});
    for (int32_t c = 0; c < 8; ++c)
      self(self, corner + blocks / 2 * Vec3i{c >> 2, c >> 1 & 1, c & 1}, blocks / 2);
  };
  descend(descend, first_block(frame), blocks_across(frame));
  std::sort(asked.begin(), asked.end(), [](const Asked& a, const Asked& b) { return a.corner < b.corner; });
  par::for_n(static_cast<int64_t>(asked.size()), threads, 16, [&](int64_t i) {
    Asked& a = asked[i];
    a.near = tree.near(points_box(frame, a.corner, brick_blocks));
  });
  BrickList bricks;
  for (Asked& a : asked) {
    const auto begin = static_cast<int64_t>(bricks.cluster.size());
    bricks.cluster.insert(bricks.cluster.end(), a.near.begin(), a.near.end());
    if (every || !a.near.empty())
      bricks.brick.push_back({a.corner, begin, static_cast<int64_t>(bricks.cluster.size())});
    a.near = {};
  }
  return bricks;
}

} // namespace molmesh::density
