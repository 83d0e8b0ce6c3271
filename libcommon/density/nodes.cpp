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

namespace {

/// Of `clusters`, those nearer than their cutoff to each of the eight cubes that begin at `corner`. Distances along
/// an axis serve four cubes; summed in the order of distance2().
void halve(const Field& f, const GridFrame& frame, std::span<const int32_t> clusters, Vec3i corner, int32_t blocks,
           std::vector<int32_t>* lists) {
  const Box low = points_box(frame, corner, blocks),
            high = points_box(frame, corner + blocks * Vec3i{1, 1, 1}, blocks);
  std::vector<int32_t> near[8];
  size_t found[8] = {};
  for (std::vector<int32_t>& list : near)
    list.resize(clusters.size());
  for (const int32_t c : clusters) {
    const Box& box = f.box[static_cast<size_t>(c)];
    double d2[3][2];
    for (int a = 0; a < 3; ++a)
      for (const bool second : {false, true}) {
        const Box& cube = second ? high : low;
        const double d = std::max(std::max(cube.lo[a] - box.hi[a], box.lo[a] - cube.hi[a]), 0.0);
        d2[a][second] = d * d;
      }
    for (size_t i = 0; i < 8; ++i) {
      near[i][found[i]] = c;
      found[i] += d2[0][i >> 2] + d2[1][i >> 1 & 1] + d2[2][i & 1] < f.cutoff2[static_cast<size_t>(c)];
    }
  }
  for (size_t i = 0; i < 8; ++i)
    if (const auto at = static_cast<int32_t>(i);
        in_grid(frame, corner + blocks * Vec3i{at >> 2, at >> 1 & 1, at & 1}))
      lists[i].assign(near[i].begin(), near[i].begin() + static_cast<std::ptrdiff_t>(found[i]));
}

} // namespace

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
    const auto n = static_cast<int64_t>(parents.node.size());
    std::vector<std::vector<int32_t>> lists(static_cast<size_t>(8 * n));
    const auto corner = [&](int64_t i) {
      const auto c = static_cast<int32_t>(i & 7);
      return parents.node[static_cast<size_t>(i >> 3)].corner + blocks * Vec3i{c >> 2, c >> 1 & 1, c & 1};
    };
    par::for_n(n, threads, 1, [&](int64_t p) {
      halve(f, frame, parents.clusters(parents.node[static_cast<size_t>(p)]), corner(8 * p), blocks,
            &lists[static_cast<size_t>(8 * p)]);
    });
    NodeList children;
    size_t total = 0;
    for (const std::vector<int32_t>& list : lists)
      total += list.size();
    children.cluster.reserve(total);
    for (int64_t i = 0; i < 8 * n; ++i) {
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
