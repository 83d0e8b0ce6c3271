// kinds.cpp — labels that are flat, vertices by the labels they are on, and sharp edges.
#include "optimize/mesh/dynamic_mesh.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace molmesh::optimize {
namespace {

struct Extent {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  /// How far apart points of one plane may lie: some units in the last place of the largest coordinate, by the
  /// digits that the coordinates carry, and no less than a share of the mesh's size.
  double rounding = 0;
};

/// Of the points that elements have: a file may hold others.
Extent extent(const DynamicMesh& m) {
  Extent all;
  double largest = 0;
  bool single = true; // from a program or a file of 32-bit coordinates
  for (size_t v = 0; v < m.point.size(); ++v) {
    const Vec3d p = m.point[v];
    for (int a = 0; a < 3 && m.incident[v] >= 0; ++a) {
      all.low[a] = std::min(all.low[a], p[a]);
      all.high[a] = std::max(all.high[a], p[a]);
      largest = std::max(largest, std::abs(p[a]));
      single = single && double(static_cast<float>(p[a])) == p[a];
    }
  }
  all.rounding = std::max(1e-12 * norm(all.high - all.low), largest * (single ? 0x1p-22 : 0x1p-50));
  return all;
}

// A label is flat when all its triangles lie in one plane normal to an axis, up to rounding, and a wall where the
// mesh ends there.
void find_flat_labels(DynamicMesh& m, const TetMesh& mesh, const std::vector<uint8_t>& label) {
  std::vector<Vec3d> low(m.labels.size(), Vec3d{1e300, 1e300, 1e300}),
      high(m.labels.size(), Vec3d{-1e300, -1e300, -1e300});
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    const size_t l = label[t];
    for (const int32_t v : mesh.tri[t])
      for (int a = 0; a < 3; ++a) {
        low[l][a] = std::min(low[l][a], mesh.point[v][a]);
        high[l][a] = std::max(high[l][a], mesh.point[v][a]);
      }
  }
  const Extent all = extent(m);
  m.walls.rounding = all.rounding;
  for (size_t l = 1; l < m.labels.size(); ++l)
    for (int a = 0; a < 3; ++a) {
      if (high[l][a] - low[l][a] > all.rounding)
        continue;
      m.labels[l].axis = a;
      const bool at_low = low[l][a] - all.low[a] <= all.rounding;
      m.labels[l].wall = at_low || all.high[a] - high[l][a] <= all.rounding;
      if (at_low)
        m.walls.low[a] = all.low[a];
      else if (m.labels[l].wall)
        m.walls.high[a] = all.high[a];
    }
}

// A label is round when all its points lie on the mesh's sphere, up to what single precision leaves of them.
void find_round_labels(DynamicMesh& m, const TetMesh& mesh, const std::vector<uint8_t>& label) {
  if (!mesh.sphere)
    return;
  m.sphere = *mesh.sphere;
  const double most = 0x1p-20 * (norm(m.sphere.center) + m.sphere.radius);
  for (size_t l = 1; l < m.labels.size(); ++l)
    m.labels[l].round = m.labels[l].name == Boundary::outer_sphere && m.labels[l].axis < 0;
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    if (m.labels[label[t]].round)
      for (const int32_t v : mesh.tri[t])
        if (!(std::abs(m.sphere.height(mesh.point[v])) <= most))
          m.labels[label[t]].round = false;
}

/// Corners of triangles at one vertex, joined across the edges there: one set for each fan.
class Fans {
public:
  explicit Fans(const std::vector<Tri>& tri) : tri_(tri) {
    root_.resize(3 * tri.size());
    std::iota(root_.begin(), root_.end(), size_t{0});
  }
  void join(int32_t t, int32_t u, int32_t v) { root_[find(corner(t, v))] = find(corner(u, v)); }
  size_t find(size_t corner) {
    while (root_[corner] != corner)
      corner = root_[corner] = root_[root_[corner]];
    return corner;
  }

private:
  size_t corner(int32_t t, int32_t v) const {
    const Tri& f = tri_[t];
    return 3 * size_t(t) + (f[0] == v ? 0u : f[1] == v ? 1u : 2u);
  }
  const std::vector<Tri>& tri_;
  std::vector<size_t> root_;
};

/// How many of the fans meet at each vertex that is noted.
class FanCounts {
public:
  void note(size_t v, size_t fan) { fan_.emplace_back(v, fan); }
  /// f(v, fans), after all notes, by ascending vertex.
  template <class F>
  void for_each(F&& f) {
    par::sort_unique(fan_, 1);
    for (size_t i = 0, j; i < fan_.size(); i = j) {
      for (j = i; j < fan_.size() && fan_[j].first == fan_[i].first;)
        ++j;
      f(fan_[i].first, j - i);
    }
  }

private:
  std::vector<std::pair<size_t, size_t>> fan_;
};

/// What meets at the vertices of one curved label and one wall: the surface's trace on the wall passes through
/// where two edges are of both labels, with one fan of the surface and no other edge that is kept.
class Traces {
public:
  explicit Traces(size_t vertices) : edges_(vertices, no_candidate) {}
  void add_candidate(size_t v) { edges_[v] = 0; }
  /// A kept edge of n triangles.
  void note_edge(int32_t a, int32_t b, bool of_both_labels, size_t n) {
    for (const int32_t v : {a, b})
      if (uint8_t& edges = edges_[v]; edges != no_candidate)
        edges =
            !of_both_labels || (edges & 3) == 2 ? no_candidate : uint8_t((edges + 1) | (n == 3 ? one_of_three : 0));
  }
  void note_fan(size_t v, size_t fan) {
    if (edges_[v] != no_candidate)
      fans_.note(v, fan);
  }
  /// f(v) where it does, after all the others.
  template <class F>
  void for_each(F&& f) {
    fans_.for_each([&](size_t v, size_t fans) {
      // With elements on both sides the surface and the wall to either side of it are fans; else all are one.
      if ((edges_[v] & 3) == 2 && fans == (edges_[v] & one_of_three ? 3 : 1))
        f(v);
    });
  }

private:
  static constexpr uint8_t no_candidate = 255, one_of_three = 4;
  std::vector<uint8_t> edges_;
  FanCounts fans_;
};

/// Vertices where two or three curved labels meet in one line: two of their edges have three triangles, all others
/// two of one label, and these make three fans.
class Lines {
public:
  explicit Lines(size_t vertices) : edges_(vertices, no_candidate) {}
  void add_candidate(size_t v) { edges_[v] = 0; }
  /// An edge that is not one of two triangles of one label.
  void note_edge(int32_t a, int32_t b, bool of_three) {
    for (const int32_t v : {a, b})
      if (uint8_t& edges = edges_[v]; edges != no_candidate)
        edges = !of_three || edges == 2 ? no_candidate : uint8_t(edges + 1);
  }
  void note_fan(size_t v, size_t fan) {
    if (edges_[v] != no_candidate)
      fans_.note(v, fan);
  }
  /// f(v) for each of them.
  template <class F>
  void for_each(F&& f) {
    fans_.for_each([&](size_t v, size_t fans) {
      if (edges_[v] == 2 && fans == 3)
        f(v);
    });
  }

private:
  static constexpr uint8_t no_candidate = 255;
  std::vector<uint8_t> edges_;
  FanCounts fans_;
};

/// The labels of the triangles at each vertex, in the order that they come in; 0: no more.
struct VertexLabels {
  std::vector<std::array<uint8_t, 3>> of;
  std::vector<uint8_t> many; ///< more than three

  VertexLabels(const TetMesh& mesh, const std::vector<uint8_t>& label)
      : of(mesh.point.size(), {0, 0, 0}), many(mesh.point.size(), 0) {
    for (size_t t = 0; t < mesh.tri.size(); ++t)
      for (const int32_t v : mesh.tri[t])
        add(size_t(v), label[t]);
  }

private:
  void add(size_t v, uint8_t l) {
    auto& s = of[v];
    size_t k = 0;
    while (k < 3 && s[k] != 0 && s[k] != l)
      ++k;
    if (k == 3)
      many[v] = 1;
    else
      s[k] = l;
  }
};

// On one curved label: of the surface; on a round one: round; on flat labels of different axes, two at most:
// sliding; else fixed.
Vertex vertex_of(const DynamicMesh& m, const std::array<uint8_t, 3>& labels, bool many) {
  Vertex x{Kind::fixed, 0, labels[0]};
  if (many)
    return x;
  if (labels[1] == 0 && m.labels[labels[0]].curved())
    x.kind = Kind::surface;
  if (labels[1] == 0 && m.labels[labels[0]].round)
    x.kind = Kind::round;
  bool flat = true;
  int frozen = 0, planes = 0;
  for (const uint8_t l : labels) {
    if (l == 0)
      continue;
    flat = flat && m.labels[l].axis >= 0;
    if (flat)
      frozen |= 1 << m.labels[l].axis, ++planes;
  }
  const int bits = (frozen & 1) + (frozen >> 1 & 1) + (frozen >> 2 & 1);
  if (flat && bits == planes && bits < 3)
    x.kind = Kind::sliding, x.frozen = static_cast<uint8_t>(frozen);
  return x;
}

bool on_surface_and_wall(const DynamicMesh& m, const std::array<uint8_t, 3>& labels, bool many) {
  return !many && labels[1] != 0 && labels[2] == 0 &&
         m.labels[labels[0]].curved() != m.labels[labels[1]].curved() &&
         (m.labels[labels[0]].wall || m.labels[labels[1]].wall);
}

/// Of a triangle.
struct Edge {
  int32_t a, b; ///< a < b
  uint8_t label;
  int32_t tri;
};

std::vector<Edge> sorted_edges(const TetMesh& mesh, const std::vector<uint8_t>& label, int threads) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.tri.size());
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    for (size_t i = 0; i < 3; ++i) {
      const int32_t v = mesh.tri[t][i], w = mesh.tri[t][(i + 1) % 3];
      edges.push_back({std::min(v, w), std::max(v, w), label[t], static_cast<int32_t>(t)});
    }
  par::sort(edges, threads, [](const Edge& x, const Edge& y) {
    return x.a != y.a ? x.a < y.a : x.b != y.b ? x.b < y.b : x.tri < y.tri;
  });
  return edges;
}

// Ends of edges of not two triangles, and of sharp ones, are fixed. The two triangles of others are of one fan.
void fix_kept_edges(DynamicMesh& m, const TetMesh& mesh, const std::vector<uint8_t>& way,
                    const std::vector<Edge>& edges, double sharp, Fans& fans, Traces& traces, Lines& lines) {
  const auto normal = [&](int32_t t) {
    const Tri& f = mesh.tri[t];
    const Vec3d p = mesh.point[f[0]];
    const Vec3d n = cross(mesh.point[f[1]] - p, mesh.point[f[2]] - p);
    return n / std::max(norm(n), 1e-300);
  };
  // Cosine of what the surface bends by: files may turn the triangles of one label either way.
  const auto bend = [&](int32_t t, int32_t u) {
    const double cosine = dot(normal(t), normal(u));
    return (way[t] ^ way[u]) & reversed ? -cosine : cosine;
  };
  const auto curved = [&](const Edge& e) { return m.labels[e.label].curved(); };
  const double limit = std::cos(sharp * 3.14159265358979323846 / 180);
  for (size_t i = 0, j; i < edges.size(); i = j) {
    const Edge& e = edges[i];
    for (j = i; j < edges.size() && edges[j].a == e.a && edges[j].b == e.b;)
      ++j;
    const bool two = j - i == 2, two_labels = two && e.label != edges[i + 1].label;
    if (two)
      for (const int32_t v : {e.a, e.b})
        fans.join(e.tri, edges[i + 1].tri, v);
    const bool keep = !two || (!two_labels && curved(e) && bend(e.tri, edges[i + 1].tri) < limit);
    const auto first = edges.begin() + std::ptrdiff_t(i), last = edges.begin() + std::ptrdiff_t(j);
    const bool of_both = (j - i == 3 || two_labels) && std::count_if(first, last, curved) == 1;
    if (keep)
      m.vertex[e.a].kind = m.vertex[e.b].kind = Kind::fixed;
    if (!two || two_labels)
      lines.note_edge(e.a, e.b, j - i == 3 && std::all_of(first, last, curved));
    if (keep || of_both)
      traces.note_edge(e.a, e.b, of_both, j - i);
  }
}

// Where the surface touches itself elements may know but one fan: such vertices are fixed.
void fix_touching(DynamicMesh& m, const TetMesh& mesh, Fans& fans, Traces& traces, Lines& lines) {
  constexpr size_t none = SIZE_MAX;
  std::vector<size_t> fan(m.point.size(), none);
  for (size_t c = 0; c < 3 * mesh.tri.size(); ++c) {
    const auto v = size_t(mesh.tri[c / 3][c % 3]);
    const size_t here = fans.find(c);
    if (fan[v] != none && fan[v] != here)
      m.vertex[v].kind = Kind::fixed;
    fan[v] = here;
    traces.note_fan(v, here);
    lines.note_fan(v, here);
  }
}

bool all_curved(const DynamicMesh& m, const std::array<uint8_t, 3>& labels, bool many) {
  return !many && labels[1] != 0 &&
         std::all_of(labels.begin(), labels.end(), [&](uint8_t l) { return l == 0 || m.labels[l].curved(); });
}

} // namespace

Vertex line_vertex(const DynamicMesh& m, std::vector<uint8_t> labels) {
  std::erase(labels, uint8_t{0});
  std::sort(labels.begin(), labels.end(), [&](uint8_t a, uint8_t b) {
    return m.labels[a].name != m.labels[b].name ? m.labels[a].name < m.labels[b].name : a < b;
  });
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  Vertex v;
  v.kind = labels.size() < 2 ? Kind::fixed : Kind::line;
  v.label = labels.front();
  v.second = labels.size() < 2 ? uint8_t{0} : labels[1];
  return v;
}

void set_kinds(DynamicMesh& m, const TetMesh& mesh, const std::vector<uint8_t>& label,
               const std::vector<uint8_t>& way, double sharp, int threads) {
  find_flat_labels(m, mesh, label);
  find_round_labels(m, mesh, label);
  const VertexLabels labels(mesh, label);
  Traces traces(m.point.size());
  Lines lines(m.point.size());
  const bool has_domains = m.order.last_domain > molmesh::Region::cavity;
  for (size_t v = 0; v < m.point.size(); ++v) {
    if (labels.of[v][0] == 0)
      continue;
    m.vertex[v] = vertex_of(m, labels.of[v], labels.many[v]);
    // Of a surface that came in alone nothing says which corners of its outline to keep.
    if (sharp >= 180 && on_surface_and_wall(m, labels.of[v], labels.many[v]))
      traces.add_candidate(v);
    if (has_domains && sharp >= 180 && all_curved(m, labels.of[v], labels.many[v]))
      lines.add_candidate(v);
  }
  Fans fans(mesh.tri);
  fix_kept_edges(m, mesh, way, sorted_edges(mesh, label, threads), sharp, fans, traces, lines);
  fix_touching(m, mesh, fans, traces, lines);
  lines.for_each([&](size_t v) {
    const auto& s = labels.of[v];
    m.vertex[v] = line_vertex(m, {s[0], s[1], s[2]});
  });
  traces.for_each([&](size_t v) {
    const auto& s = labels.of[v];
    const bool flat_first = !m.labels[s[0]].curved();
    m.vertex[v] = {.kind = Kind::trace,
                   .frozen = static_cast<uint8_t>(1 << m.labels[s[flat_first ? 0 : 1]].axis),
                   .label = s[flat_first ? 1 : 0]};
  });
}

} // namespace molmesh::optimize
