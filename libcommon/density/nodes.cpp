// nodes.cpp — the descent through boxes, and the walk that asks a kd-tree.
#include "density/nodes.hpp"
#include "density/cluster_tree.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <numeric>

namespace molmesh::density {

std::span<const int32_t> NodeList::clusters_at(Vec3i corner) const {
  const auto at =
      std::lower_bound(node.begin(), node.end(), corner, [](const Node& a, Vec3i c) { return a.corner < c; });
  return at != node.end() && at->corner == corner ? clusters(*at) : std::span<const int32_t>();
}

Box points_box(const GridFrame& frame, Vec3i corner, int32_t blocks) {
  const Vec3i first = 8 * corner;
  return {frame.position(first), frame.position(first + Vec3i{1, 1, 1} * (8 * blocks - 1))};
}

Vec3i first_block(const GridFrame& frame) {
  return {frame.lower.x >> 3, frame.lower.y >> 3, frame.lower.z >> 3};
}

bool in_grid(const GridFrame& frame, Vec3i block) {
  for (int a = 0; a < 3; ++a)
    if (8 * (int64_t{block[a]} + 1) <= frame.lower[a] ||
        8 * int64_t{block[a]} >= int64_t{frame.lower[a]} + frame.points[a])
      return false;
  return true;
}

NodeList nodes_by_halving(const Field& f, const GridFrame& frame, bool every, int threads) {
  int32_t blocks = node_blocks;
  const Vec3i first = first_block(frame);
  for (int a = 0; a < 3; ++a)
    while (8 * (int64_t{first[a]} + blocks) < int64_t{frame.lower[a]} + frame.points[a])
      blocks *= 2;
  NodeList parents;
  parents.cluster.resize(static_cast<size_t>(f.clusters()));
  std::iota(parents.cluster.begin(), parents.cluster.end(), 0);
  parents.node.push_back({first, 0, f.clusters()});
  while (blocks > node_blocks) {
    blocks /= 2;
    const auto n = static_cast<int64_t>(parents.node.size()) * 8;
    std::vector<std::vector<int32_t>> lists(static_cast<size_t>(n));
    const auto corner = [&](int64_t i) {
      const auto c = static_cast<int32_t>(i & 7);
      return parents.node[static_cast<size_t>(i >> 3)].corner + blocks * Vec3i{c >> 2, c >> 1 & 1, c & 1};
    };
    par::for_n(n, threads, 1, [&](int64_t i) {
      if (!in_grid(frame, corner(i)))
        return;
      const Box box = points_box(frame, corner(i), blocks);
      for (const int32_t c : parents.clusters(parents.node[static_cast<size_t>(i >> 3)]))
        if (distance2(box, f.box[static_cast<size_t>(c)]) < f.cutoff2[static_cast<size_t>(c)])
          lists[static_cast<size_t>(i)].push_back(c);
    });
    NodeList children;
    for (int64_t i = 0; i < n; ++i) {
      const std::vector<int32_t>& list = lists[static_cast<size_t>(i)];
      if (list.empty() && !(every && in_grid(frame, corner(i))))
        continue;
      const auto begin = static_cast<int64_t>(children.cluster.size());
      children.cluster.insert(children.cluster.end(), list.begin(), list.end());
      children.node.push_back({corner(i), begin, static_cast<int64_t>(children.cluster.size())});
    }
    parents = std::move(children);
  }
  std::sort(parents.node.begin(), parents.node.end(),
            [](const Node& a, const Node& b) { return a.corner < b.corner; });
  return parents;
}

NodeList nodes_by_tree(const Field& f, const GridFrame& frame, bool every, int threads) {
  const ClusterTree tree(f);
  NodeList nodes;
  Vec3i n;
  const Vec3i first = first_block(frame);
  for (int a = 0; a < 3; ++a)
    n[a] = (((frame.lower[a] + frame.points[a] + 7) >> 3) - first[a] + node_blocks - 1) / node_blocks;
  std::vector<std::vector<int32_t>> lists(static_cast<size_t>(n.z));
  for (int32_t x = 0; x < n.x; ++x)
    for (int32_t y = 0; y < n.y; ++y) {
      const auto corner = [&](int64_t z) { return first + node_blocks * Vec3i{x, y, static_cast<int32_t>(z)}; };
      par::for_n(n.z, threads, 1, [&](int64_t z) {
        lists[static_cast<size_t>(z)] = tree.near(points_box(frame, corner(z), node_blocks));
      });
      for (int64_t z = 0; z < n.z; ++z) {
        const std::vector<int32_t>& list = lists[static_cast<size_t>(z)];
        if (list.empty() && !every)
          continue;
        const auto begin = static_cast<int64_t>(nodes.cluster.size());
        nodes.cluster.insert(nodes.cluster.end(), list.begin(), list.end());
        nodes.node.push_back({corner(z), begin, static_cast<int64_t>(nodes.cluster.size())});
      }
    }
  return nodes;
}

} // namespace molmesh::density
