// partition.cpp — parts of the output: METIS on the dual graph of the tetrahedra, or of compact clusters of them.
#include "mesh/partition.hpp"
#include "base/error.hpp"
#include "geom/hilbert.hpp" // clusters follow the curve
#include "mesh/adjacency.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <array>
#include <metis.h>

namespace molmesh {
namespace {

static_assert(sizeof(idx_t) == sizeof(int32_t), "METIS with 32-bit indices");

// METIS is serial and takes 100 bytes and 0.7 µs a node: of a large mesh it gets clusters of tetrahedra.
constexpr int64_t most_in_cluster = 32;
constexpr int64_t cluster_size(int64_t tets) {
  return tets < 1 << 14 ? 1 : tets < 1 << 17 ? 8 : most_in_cluster;
}
// With fewer nodes a part METIS leaves parts empty, and says so on standard output where it has nothing to bisect.
constexpr int64_t fewest_nodes = 20;

// Tetrahedra along the Hilbert curve of their centroids, 256 places an axis; else as they come.
LargeArray<uint32_t> along_curve(const TetMesh& m, int threads) {
  constexpr int bits = 8;
  Vec3d low = m.point[0], high = low;
  for (const Vec3d& p : m.point)
    for (int a = 0; a < 3; ++a)
      low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const double scale = ((1 << bits) - 1e-3) / std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
  const auto n = static_cast<int64_t>(m.tet.size());
  LargeArray<uint32_t> key(m.tet.size()), by_lower(m.tet.size()), order(m.tet.size());
  par::for_n(n, threads, [&](int64_t t) {
    Vec3d c;
    for (const int32_t v : m.tet[t])
      c += 0.25 * scale * (m.point[v] - low);
    const auto at = [](double x) { return static_cast<int32_t>(x); };
    key[t] = static_cast<uint32_t>(hilbert({at(c.x), at(c.y), at(c.z)}, bits));
  });
  // By either half of the key: to count all keys takes longer than a small mesh.
  constexpr int half = 3 * bits / 2;
  constexpr int64_t halves = int64_t{1} << half;
  par::place_by(
      n, halves, threads, [&](int64_t t) { return key[t] % halves; }, [](int64_t) {},
      [&](int64_t k, int64_t t) { by_lower[k] = static_cast<uint32_t>(t); });
  par::place_by(
      n, halves, threads, [&](int64_t k) { return key[by_lower[k]] / halves; }, [](int64_t) {},
      [&](int64_t k, int64_t j) { order[k] = by_lower[j]; });
  return order;
}

/// Nodes are clusters, weighted by their tetrahedra; edges by the faces between them.
struct Graph {
  LargeArray<int32_t> cluster; ///< [tets]
  std::vector<idx_t> begin, neighbor, node_weight, edge_weight;
};

/// Values that come many times over, at most `most` in all.
class FewValues {
public:
  static constexpr size_t most = 4 * most_in_cluster;
  void clear() { size_ = 0, table_ = {}; }
  void add(int32_t value) {
    size_t at = (uint32_t(value) * 0x9E3779B9u >> 16) % table_.size();
    while (table_[at].n > 0 && table_[at].value != value)
      at = (at + 1) % table_.size();
    if (table_[at].n++ == 0) {
      table_[at].value = value;
      used_[size_++] = static_cast<uint16_t>(at);
    }
  }
  size_t size() const { return size_; } ///< each once
  /// f(value, how often), ascending.
  template <class F>
  void for_each(F&& f) {
    std::sort(used_.begin(), used_.begin() + size_,
              [&](uint16_t a, uint16_t b) { return table_[a].value < table_[b].value; });
    for (size_t i = 0; i < size_; ++i)
      f(table_[used_[i]].value, table_[used_[i]].n);
  }

private:
  struct Count {
    int32_t value, n;
  };
  std::array<Count, 2 * most> table_{}; ///< by open addressing
  std::array<uint16_t, most> used_{};
  size_t size_ = 0;
};

Graph dual_graph(const TetMesh& m, int64_t size, int threads, const LargeArray<int32_t>& across) {
  const auto n = static_cast<int64_t>(m.tet.size());
  const int64_t nodes = (n + size - 1) / size;
  LargeArray<uint32_t> order;
  if (size > 1)
    order = along_curve(m, threads);
  const auto tet_at = [&](int64_t k) { return size > 1 ? int64_t{order[k]} : k; };
  Graph g;
  g.cluster.resize(m.tet.size());
  g.node_weight.resize(size_t(nodes));
  g.begin.assign(size_t(nodes + 1), 0);
  par::for_n(n, threads, [&](int64_t k) { g.cluster[tet_at(k)] = static_cast<int32_t>(k / size); });
  struct Edges {
    std::vector<idx_t> neighbor, weight;
  };
  constexpr int64_t chunk = 1024; // nodes
  std::vector<Edges> part(size_t((nodes + chunk - 1) / chunk));
  par::for_n(static_cast<int64_t>(part.size()), threads, 1, [&](int64_t c) {
    FewValues near;
    std::array<int32_t, FewValues::most + 1> beyond;
    Edges& edges = part[c];
    for (int64_t node = c * chunk; node < std::min(nodes, (c + 1) * chunk); ++node) {
      const int64_t first = node * size, last = std::min(n, first + size);
      size_t count = 0;
      for (int64_t k = first; k < last; ++k)
        for (int64_t face = 4 * tet_at(k), end = face + 4; face < end; ++face) {
          const int32_t other = across[face];
          beyond[count] = other < 0 ? static_cast<int32_t>(node) : g.cluster[other];
          count += beyond[count] != node; // no branch: which it is is a guess
        }
      near.clear();
      for (size_t i = 0; i < count; ++i)
        near.add(beyond[i]);
      near.for_each([&](int32_t neighbor, int32_t faces) {
        edges.neighbor.push_back(neighbor);
        edges.weight.push_back(faces);
      });
      g.begin[node] = static_cast<idx_t>(near.size());
      g.node_weight[node] = static_cast<idx_t>(last - first);
    }
  });
  const auto edges = size_t(par::exclusive_scan(g.begin));
  g.neighbor.resize(edges);
  g.edge_weight.resize(edges);
  par::for_n(static_cast<int64_t>(part.size()), threads, 1, [&](int64_t c) {
    const Edges& own = part[c];
    std::copy(own.neighbor.begin(), own.neighbor.end(), g.neighbor.begin() + g.begin[c * chunk]);
    std::copy(own.weight.begin(), own.weight.end(), g.edge_weight.begin() + g.begin[c * chunk]);
  });
  return g;
}

// Runs of equal length along the curve.
std::vector<int32_t> cut_curve(const TetMesh& m, int64_t parts, int threads) {
  const LargeArray<uint32_t> order = along_curve(m, threads);
  const auto n = static_cast<int64_t>(order.size());
  std::vector<int32_t> part(order.size());
  par::for_n(n, threads, [&](int64_t k) { part[order[k]] = static_cast<int32_t>(k * parts / n); });
  return part;
}

// An empty part takes the second half of the largest along the curve.
void fill_empty_parts(const TetMesh& m, std::vector<int32_t>& part, int32_t parts, int threads) {
  std::vector<int64_t> size(size_t(parts), 0);
  for (const int32_t p : part)
    ++size[p];
  if (std::find(size.begin(), size.end(), 0) == size.end())
    return;
  const LargeArray<uint32_t> order = along_curve(m, threads);
  for (int32_t p = 0; p < parts; ++p) {
    if (size[p] > 0)
      continue;
    const auto largest = static_cast<int32_t>(std::max_element(size.begin(), size.end()) - size.begin());
    int64_t kept = (size[largest] + 1) / 2;
    for (const uint32_t t : order)
      if (part[t] == largest && kept-- <= 0) {
        part[t] = p;
        ++size[p], --size[largest];
      }
  }
}

} // namespace

std::vector<int32_t> partition(const TetMesh& m, int parts, int threads, LargeArray<int32_t> across) {
  std::vector<int32_t> part;
  par::reserve_pages(part, m.tet.size(), 0, threads);
  part.resize(m.tet.size());
  if (std::min<int64_t>(parts, int64_t(m.tet.size())) <= 1)
    return part;
  const auto tets = static_cast<int64_t>(m.tet.size());
  auto k = static_cast<idx_t>(std::min<int64_t>(parts, tets));
  int64_t size = cluster_size(tets);
  while (size > 1 && tets < fewest_nodes * size * k)
    size /= 2;
  if (tets < fewest_nodes * k)
    return cut_curve(m, k, threads);
  if (across.empty()) {
    across = face_neighbors(m, threads);
    for (int32_t& f : across)
      f = f < 0 ? -1 : f / 4;
  }
  Graph g = dual_graph(m, size, threads, across);
  auto n = static_cast<idx_t>(g.node_weight.size());
  std::vector<idx_t> part_of(size_t(n), 0);
  idx_t options[METIS_NOPTIONS], constraints = 1, cut = 0;
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  across = {};
  const int status =
      METIS_PartGraphKway(&n, &constraints, g.begin.data(), g.neighbor.data(), g.node_weight.data(), nullptr,
                          g.edge_weight.data(), &k, nullptr, nullptr, options, &cut, part_of.data());
  if (status != METIS_OK)
    fail(Status::failed, "METIS cannot partition this mesh (status " + std::to_string(status) + ")");
  par::for_n(int64_t(part.size()), threads, [&](int64_t t) { part[t] = part_of[g.cluster[t]]; });
  fill_empty_parts(m, part, k, threads);
  return part;
}

} // namespace molmesh
