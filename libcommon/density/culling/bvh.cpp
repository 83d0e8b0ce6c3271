// bvh.cpp — halves cubes and tests the boxes of clusters against them.
#include "density/culling/bvh.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>

namespace molmesh::density {

namespace {

constexpr size_t at_once = 1024; // clusters

/// Of `clusters`, those nearer than their cutoff to each of the eight cubes that begin at `corner`. Distances along
/// an axis serve four cubes; summed in the order of distance2().
void halve(const Field& f, const GridFrame& frame, const BlockRange& range, std::span<const int32_t> clusters,
           Vec3i corner, int32_t blocks, std::vector<int32_t>* lists) {
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
        range.meets(corner + blocks * Vec3i{at >> 2, at >> 1 & 1, at & 1}, blocks))
      lists[i].assign(near[i], near[i] + found[i]);
}

/// The eight halves of every parent, `blocks` wide; without `every` those that have clusters.
BrickList halves(const Field& f, const GridFrame& frame, const BlockRange& range, const BrickList& parents,
                 int32_t blocks, bool every, int threads) {
  struct Piece {
    size_t parent, first, count; // clusters of the parent
    std::vector<int32_t> lists[8];
    size_t to[8];
  };
  std::vector<Piece> pieces;
  for (size_t p = 0; p < parents.brick.size(); ++p) {
    const size_t n = parents.clusters(parents.brick[p]).size();
    for (size_t first = 0; first == 0 || first < n; first += at_once)
      pieces.push_back({p, first, std::min(at_once, n - first), {}, {}});
  }
  const auto n = static_cast<int64_t>(pieces.size());
  par::for_n(n, threads, 1, [&](int64_t i) {
    Piece& p = pieces[i];
    const Brick& parent = parents.brick[p.parent];
    halve(f, frame, range, parents.clusters(parent).subspan(p.first, p.count), parent.corner, blocks, p.lists);
  });
  BrickList children;
  int64_t total = 0;
  for (size_t begin = 0, end; begin < pieces.size(); begin = end) {
    for (end = begin + 1; end < pieces.size() && pieces[end].first > 0; ++end)
      ;
    for (int32_t c = 0; c < 8; ++c) {
      const Vec3i corner = parents.brick[pieces[begin].parent].corner + blocks * Vec3i{c >> 2, c >> 1 & 1, c & 1};
      const int64_t first = total;
      for (size_t p = begin; p < end; ++p) {
        pieces[p].to[c] = static_cast<size_t>(total);
        total += static_cast<int64_t>(pieces[p].lists[c].size());
      }
      if (total > first || (every && range.meets(corner, blocks)))
        children.brick.push_back({corner, first, total});
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

/// Bytes of the list that comes of these bricks at least: where a cluster's cutoff reaches all over a brick, all
/// parts of the brick have the cluster.
double sure_bytes(const Field& f, const GridFrame& frame, const BlockRange& range, const BrickList& bricks,
                  int32_t blocks) {
  double bytes = 0;
  for (const Brick& n : bricks.brick) {
    if (!range.meets(n.corner, 1) || !range.meets(n.corner + (blocks - 1) * Vec3i{1, 1, 1}, 1))
      continue;
    const Box cube = points_box(frame, n.corner, blocks);
    int64_t everywhere = 0;
    for (const int32_t c : bricks.clusters(n)) {
      const Box& box = f.box[c];
      double farthest2 = 0;
      for (int a = 0; a < 3; ++a) {
        const double d = std::max({cube.hi[a] - box.hi[a], box.lo[a] - cube.lo[a], 0.0});
        farthest2 += d * d;
      }
      everywhere += farthest2 < f.cutoff2[c];
    }
    if (everywhere > 0)
      bytes += double(sizeof(Brick)) + double(sizeof(int32_t)) * double(everywhere);
  }
  return bytes * std::pow(blocks / brick_blocks, 3);
}

void require_memory(double bytes) {
  if (bytes > 1e15)
    throw std::bad_alloc();
  ::operator delete(::operator new(static_cast<size_t>(bytes)));
}

} // namespace

BrickList bricks_by_bvh(const Field& f, const GridFrame& frame, const BlockRange& range, bool every, int threads) {
  int32_t blocks = blocks_across(frame);
  BrickList bricks;
  bricks.cluster.resize(static_cast<size_t>(f.clusters()));
  std::iota(bricks.cluster.begin(), bricks.cluster.end(), 0);
  bricks.brick.push_back({first_block(frame), 0, f.clusters()});
  while (blocks > brick_blocks) {
    blocks /= 2;
    bricks = halves(f, frame, range, bricks, blocks, every, threads);
    if (blocks >= 16 * brick_blocks) // what no memory holds is refused before the time is spent
      require_memory(sure_bytes(f, frame, range, bricks, blocks));
  }
  std::sort(bricks.brick.begin(), bricks.brick.end(),
            [](const Brick& a, const Brick& b) { return a.corner < b.corner; });
  return bricks;
}

} // namespace molmesh::density
