// nodes.cpp — the descent through boxes, by lists of clusters or asking a kd-tree.
#include "density/culling/nodes.hpp"
#include "density/culling/cluster_tree.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <new>
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

constexpr size_t at_once = 1024; // clusters

/// Of `clusters`, those nearer than their cutoff to each of the eight cubes that begin at `corner`. Distances along
/// an axis serve four cubes; summed in the order of distance2().
void halve(const Field& f, const GridFrame& frame, std::span<const int32_t> clusters, Vec3i corner, int32_t blocks,
           std::vector<int32_t>* lists) {
  const Box low = points_box(frame, corner, blocks),
            high = points_box(frame, corner + blocks * Vec3i{1, 1, 1}, blocks);
  int32_t near[8][at_once];
  size_t found[8] = {};
  for (const int32_t c : clusters) {
    const Box& box = f.box[c];
    double d2[3][2];
    for (int a = 0; a < 3; ++a)
      for (const bool second : {false, true}) {
        const Box& cube = second ? high : low;
        const double d = std::max(std::max(cube.lo[a] - box.hi[a], box.lo[a] - cube.hi[a]), 0.0);
        d2[a][second] = d * d;
      }
    for (size_t i = 0; i < 8; ++i) {
      near[i][found[i]] = c;
      found[i] += d2[0][i >> 2] + d2[1][i >> 1 & 1] + d2[2][i & 1] < f.cutoff2[c];
    }
  }
  for (size_t i = 0; i < 8; ++i)
    if (const auto at = static_cast<int32_t>(i);
        in_grid(frame, corner + blocks * Vec3i{at >> 2, at >> 1 & 1, at & 1}))
      lists[i].assign(near[i], near[i] + found[i]);
}

/// The eight halves of every parent, `blocks` wide; without `every` those that have clusters.
NodeList halves(const Field& f, const GridFrame& frame, const NodeList& parents, int32_t blocks, bool every,
                int threads) {
  struct Piece {
    size_t parent, first, count; // clusters of the parent
    std::vector<int32_t> lists[8];
    size_t to[8];
  };
  std::vector<Piece> pieces;
  for (size_t p = 0; p < parents.node.size(); ++p) {
    const size_t n = parents.clusters(parents.node[p]).size();
    for (size_t first = 0; first == 0 || first < n; first += at_once)
      pieces.push_back({p, first, std::min(at_once, n - first), {}, {}});
  }
  const auto n = static_cast<int64_t>(pieces.size());
  par::for_n(n, threads, 1, [&](int64_t i) {
    Piece& p = pieces[i];
    const Node& parent = parents.node[p.parent];
    halve(f, frame, parents.clusters(parent).subspan(p.first, p.count), parent.corner, blocks, p.lists);
  });
  NodeList children;
  int64_t total = 0;
  for (size_t begin = 0, end; begin < pieces.size(); begin = end) {
    for (end = begin + 1; end < pieces.size() && pieces[end].first > 0; ++end)
      ;
    for (int32_t c = 0; c < 8; ++c) {
      const Vec3i corner = parents.node[pieces[begin].parent].corner + blocks * Vec3i{c >> 2, c >> 1 & 1, c & 1};
      const int64_t first = total;
      for (size_t p = begin; p < end; ++p) {
        pieces[p].to[c] = static_cast<size_t>(total);
        total += static_cast<int64_t>(pieces[p].lists[c].size());
      }
      if (total > first || (every && in_grid(frame, corner)))
        children.node.push_back({corner, first, total});
    }
  }
  children.cluster.resize(static_cast<size_t>(total));
  par::for_n(n, threads, 16, [&](int64_t i) {
    Piece& p = pieces[i];
    for (size_t c = 0; c < 8; ++c) {
      std::copy(p.lists[c].begin(), p.lists[c].end(), children.cluster.data() + p.to[c]);
      p.lists[c] = {};
    }
  });
  return children;
}

/// Bytes of the list that comes of these nodes at least: where a cluster's cutoff reaches all over a node, all
/// parts of the node have the cluster.
double sure_bytes(const Field& f, const GridFrame& frame, const NodeList& nodes, int32_t blocks) {
  double bytes = 0;
  for (const Node& n : nodes.node) {
    if (!in_grid(frame, n.corner) || !in_grid(frame, n.corner + (blocks - 1) * Vec3i{1, 1, 1}))
      continue;
    const Box cube = points_box(frame, n.corner, blocks);
    int64_t everywhere = 0;
    for (const int32_t c : nodes.clusters(n)) {
      const Box& box = f.box[c];
      double farthest2 = 0;
      for (int a = 0; a < 3; ++a) {
        const double d = std::max({cube.hi[a] - box.hi[a], box.lo[a] - cube.lo[a], 0.0});
        farthest2 += d * d;
      }
      everywhere += farthest2 < f.cutoff2[c];
    }
    if (everywhere > 0)
      bytes += double(sizeof(Node)) + double(sizeof(int32_t)) * double(everywhere);
  }
  return bytes * std::pow(blocks / node_blocks, 3);
}

/// The least power of two of nodes that spans the grid.
int32_t blocks_across(const GridFrame& frame) {
  int32_t blocks = node_blocks;
  const Vec3i first = first_block(frame);
  for (int a = 0; a < 3; ++a)
    while (8 * (int64_t{first[a]} + blocks) < int64_t{frame.lower[a]} + frame.points[a])
      blocks *= 2;
  return blocks;
}

void require_memory(double bytes) {
  if (bytes > 1e15)
    throw std::bad_alloc();
  ::operator delete(::operator new(static_cast<size_t>(bytes)));
}

} // namespace

NodeList nodes_by_halving(const Field& f, const GridFrame& frame, bool every, int threads) {
  int32_t blocks = blocks_across(frame);
  NodeList nodes;
  nodes.cluster.resize(static_cast<size_t>(f.clusters()));
  std::iota(nodes.cluster.begin(), nodes.cluster.end(), 0);
  nodes.node.push_back({first_block(frame), 0, f.clusters()});
  while (blocks > node_blocks) {
    blocks /= 2;
    nodes = halves(f, frame, nodes, blocks, every, threads);
    if (blocks >= 16 * node_blocks) // what no memory holds is refused before the time is spent
      require_memory(sure_bytes(f, frame, nodes, blocks));
  }
  std::sort(nodes.node.begin(), nodes.node.end(), [](const Node& a, const Node& b) { return a.corner < b.corner; });
  return nodes;
}

NodeList nodes_by_tree(const Field& f, const GridFrame& frame, bool every, int threads) {
  const ClusterTree tree(f);
  struct Asked {
    Vec3i corner;
    std::vector<int32_t> near;
  };
  std::vector<Asked> asked;
  constexpr int32_t together = 4 * node_blocks; // of a cube that has any, the tree is asked for every node
  const auto descend = [&](auto&& self, Vec3i corner, int32_t blocks) -> void {
    if (!in_grid(frame, corner) ||
        (!every && blocks >= together && tree.near(points_box(frame, corner, blocks)).empty()))
      return;
    if (blocks == node_blocks)
      return asked.push_back({corner, {}});
    for (int32_t c = 0; c < 8; ++c)
      self(self, corner + blocks / 2 * Vec3i{c >> 2, c >> 1 & 1, c & 1}, blocks / 2);
  };
  descend(descend, first_block(frame), blocks_across(frame));
  std::sort(asked.begin(), asked.end(), [](const Asked& a, const Asked& b) { return a.corner < b.corner; });
  par::for_n(static_cast<int64_t>(asked.size()), threads, 16, [&](int64_t i) {
    Asked& a = asked[i];
    a.near = tree.near(points_box(frame, a.corner, node_blocks));
  });
  NodeList nodes;
  for (Asked& a : asked) {
    const auto begin = static_cast<int64_t>(nodes.cluster.size());
    nodes.cluster.insert(nodes.cluster.end(), a.near.begin(), a.near.end());
    if (every || !a.near.empty())
      nodes.node.push_back({a.corner, begin, static_cast<int64_t>(nodes.cluster.size())});
    a.near = {};
  }
  return nodes;
}

} // namespace molmesh::density
