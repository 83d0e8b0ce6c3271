// partition.cpp — METIS on the dual graph: of tetrahedra, or of compact clusters of them where there are many.
#include "mesh/partition.hpp"
#include "error.hpp"
#include "geom/hilbert.hpp" // clusters follow the curve
#include "mesh/adjacency.hpp"
#include "par/par.hpp"
#include <metis.h>
#include <utility>

namespace molmesh {
namespace {

static_assert(sizeof(idx_t) == sizeof(int32_t), "METIS with 32-bit indices");

// METIS is serial and takes 100 bytes and 0.7 µs a tetrahedron: of a large mesh it gets clusters of this many.
constexpr int64_t cluster_size = 32, large = 1 << 17;

// Tetrahedra along the Hilbert curve of their centroids, 256 places an axis; else as they come.
LargeArray<uint32_t> along_curve(const TetMesh& m, int threads) {
  constexpr int bits = 8;
  Vec3d low = m.point[0], high = low;
  for (const Vec3d& p : m.point)
    for (int a = 0; a < 3; ++a)
      low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const double scale = ((1 << bits) - 1e-3) / std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
  const auto n = static_cast<int64_t>(m.tet.size());
  LargeArray<uint32_t> key(m.tet.size()), order(m.tet.size());
  par::for_n(n, threads, [&](int64_t t) {
    Vec3d c;
    for (const int32_t v : m.tet[size_t(t)])
      c += 0.25 * scale * (m.point[size_t(v)] - low);
    const auto at = [](double x) { return static_cast<int32_t>(x); };
    key[size_t(t)] = static_cast<uint32_t>(hilbert({at(c.x), at(c.y), at(c.z)}, bits));
  });
  par::place_by(
      n, int64_t{1} << 3 * bits, threads, [&](int64_t t) { return int64_t{key[size_t(t)]}; }, [](int64_t) {},
      [&](int64_t k, int64_t t) { order[size_t(k)] = static_cast<uint32_t>(t); });
  return order;
}

/// Nodes are clusters, weighted by their tetrahedra; edges by the faces between them.
struct Graph {
  LargeArray<int32_t> cluster; ///< [tets]
  std::vector<idx_t> begin, neighbor, node_weight, edge_weight;
};

Graph dual_graph(const TetMesh& m, int threads, LargeArray<int32_t> across) {
  const auto n = static_cast<int64_t>(m.tet.size()), size = n < large ? 1 : cluster_size;
  const int64_t nodes = (n + size - 1) / size;
  LargeArray<uint32_t> order;
  if (size > 1)
    order = along_curve(m, threads);
  const auto tet_at = [&](int64_t k) { return size > 1 ? int64_t{order[size_t(k)]} : k; };
  Graph g;
  g.cluster.resize(m.tet.size());
  g.node_weight.resize(size_t(nodes));
  g.begin.assign(size_t(nodes + 1), 0);
  par::for_n(n, threads, [&](int64_t k) { g.cluster[size_t(tet_at(k))] = static_cast<int32_t>(k / size); });
  // f(of the tetrahedron across) for the faces of a node's tetrahedra, while it says so.
  const auto each_face = [&](int64_t node, auto&& f) {
    for (int64_t k = node * size, end = std::min(n, k + size); k < end; ++k)
      for (int64_t face = 4 * tet_at(k), last = face + 4; face < last; ++face)
        if (!f(across[size_t(face)]))
          return;
  };
  // A node's neighbours, ascending, one for every face, then -1: in place of its tetrahedra's own.
  par::for_n(nodes, threads, [&](int64_t node) {
    std::array<int32_t, 4 * cluster_size> near;
    size_t count = 0, placed = 0;
    each_face(node, [&](int32_t other) {
      if (other >= 0 && g.cluster[size_t(other)] != node)
        near[count++] = g.cluster[size_t(other)];
      return true;
    });
    std::sort(near.begin(), near.begin() + count);
    each_face(node, [&](int32_t& other) {
      other = placed < count ? near[placed] : -1;
      return placed++ < count;
    });
    g.begin[size_t(node)] = static_cast<idx_t>(std::unique(near.begin(), near.begin() + count) - near.begin());
    g.node_weight[size_t(node)] = static_cast<idx_t>(std::min(n, (node + 1) * size) - node * size);
  });
  const auto edges = size_t(par::exclusive_scan(g.begin));
  g.neighbor.resize(edges);
  g.edge_weight.resize(edges);
  par::for_n(nodes, threads, [&](int64_t node) {
    auto at = size_t(g.begin[size_t(node)]) - 1;
    int32_t last = -1;
    each_face(node, [&](int32_t other) {
      if (other < 0)
        return false;
      if (other != last)
        g.neighbor[++at] = last = other;
      ++g.edge_weight[at];
      return true;
    });
  });
  return g;
}

} // namespace

std::vector<int32_t> partition(const TetMesh& m, int parts, int threads, LargeArray<int32_t> across) {
  std::vector<int32_t> part(m.tet.size(), 0);
  if (std::min<int64_t>(parts, int64_t(m.tet.size())) <= 1)
    return part;
  if (across.empty()) {
    across = face_neighbors(m, threads);
    for (int32_t& f : across)
      f = f < 0 ? -1 : f / 4;
  }
  Graph g = dual_graph(m, threads, std::move(across));
  auto n = static_cast<idx_t>(g.node_weight.size());
  idx_t k = std::min<idx_t>(parts, n);
  std::vector<idx_t> part_of(size_t(n), 0);
  idx_t options[METIS_NOPTIONS], constraints = 1, cut = 0;
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  const int status =
      METIS_PartGraphKway(&n, &constraints, g.begin.data(), g.neighbor.data(), g.node_weight.data(), nullptr,
                          g.edge_weight.data(), &k, nullptr, nullptr, options, &cut, part_of.data());
  if (status != METIS_OK)
    fail(Status::failed, "METIS cannot partition this mesh (status " + std::to_string(status) + ")");
  par::for_n(int64_t(part.size()), threads,
             [&](int64_t t) { part[size_t(t)] = part_of[size_t(g.cluster[size_t(t)])]; });
  return part;
}

} // namespace molmesh
