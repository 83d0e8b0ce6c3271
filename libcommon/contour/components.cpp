// components.cpp — union-find over the vertices of the complex.
#include "contour/components.hpp"
#include "contour/detail/at.hpp"
#include "geom/tet_measures.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>

namespace molmesh::contour {

using detail::at;
namespace {

/// Union-find over vertices; the lowest of a set names it.
class Sets {
public:
  Sets(size_t n, int threads) : parent_(n) {
    par::for_n(static_cast<int64_t>(n), threads, [&](int64_t i) { parent_[at(i)] = static_cast<int32_t>(i); });
  }
  int32_t find(int32_t i) {
    while (parent_[at(i)] != i)
      i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }
  int32_t find(int32_t i) const {
    while (parent_[at(i)] != i)
      i = parent_[at(i)];
    return i;
  }
  void join(int32_t a, int32_t b) {
    a = find(a), b = find(b);
    if (a != b)
      parent_[at(std::max(a, b))] = std::min(a, b);
  }

private:
  LargeArray<int32_t> parent_;
};

/// Calls join(a, b) for vertices of the leaf that lie in one part.
template <class Join>
void join_leaf(const ComplexView& c, int32_t leaf, Join join) {
  const auto vertex = [&](int k) { return c.corner_vertex(leaf, k); };
  const auto join_if_same = [&](int32_t a, int32_t b) {
    if (c.inside(a) == c.inside(b))
      join(a, b);
  };
  if (c.side[leaf] != Side::crossed) {
    for (int k = 1; k < 8; ++k)
      join(vertex(0), vertex(k));
    return;
  }
  for (int k = 0; k < 8; ++k)
    for (int bit = 1; bit < 8; bit *= 2)
      if (!(k & bit))
        join_if_same(vertex(k), vertex(k | bit));
  if (c.tree.level[leaf] > 0)
    return;
  const CellTopology t = c.topology(leaf);
  for (int f = 0; f < 6; ++f)
    if (t.diagonal[at(f)] != Diagonal::none) {
      const auto [a, b] = diagonal_corners(f, t.diagonal[at(f)]);
      join(vertex(a), vertex(b));
    }
  if (c.is_split(leaf))
    for (int k = 0; k < 8; ++k)
      if (k != t.chop)
        join_if_same(vertex(k), c.split[leaf]);
}

/// Runs of leaves side by side, each joining what lies in its own share of the vertices (a leaf's corners are
/// numbered near its place on the curve); the rest follows.
Sets join_leaves(const ComplexView& c, int threads) {
  Sets sets(at(c.vertices()), threads);
  const int64_t runs = std::max(1, threads), leaves = c.tree.leaves;
  std::vector<std::vector<std::array<int32_t, 2>>> rest(at(runs));
  par::for_n(runs, threads, 1, [&](int64_t r) {
    const auto bound = [&](int64_t run) { // the first vertex of a run
      const int64_t leaf = leaves * run / runs;
      return run == 0 ? 0 : leaf == leaves ? c.dual0 : c.corner_vertex(static_cast<int32_t>(leaf), 0);
    };
    const int32_t lowest = bound(r), end = bound(r + 1);
    const auto mine = [&](int32_t v) { return v >= lowest && v < end; };
    for (int64_t leaf = leaves * r / runs; leaf < leaves * (r + 1) / runs; ++leaf)
      join_leaf(c, static_cast<int32_t>(leaf), [&](int32_t a, int32_t b) {
        if (mine(a) && mine(b))
          sets.join(a, b);
        else
          rest[at(r)].push_back({a, b});
      });
  });
  for (const auto& pairs : rest)
    for (const auto& [a, b] : pairs)
      sets.join(a, b);
  return sets;
}

void assign_regions(Components& found, const Elements& elements, const RegionOptions& options) {
  for (Component& c : found.component)
    c.region = c.inside ? molecule : c.at_wall ? outside : cavity;
  if (options.fill_cavities)
    for (Component& c : found.component)
      if (c.region == cavity)
        c.region = molecule;
  if (!(options.drop_below > 0))
    return;
  // A dropped part takes the region round it; where parts nest, the outermost decides first.
  std::vector<uint8_t> dropped(found.component.size(), 0);
  for (size_t i = 0; i < found.component.size(); ++i) {
    const Component& c = found.component[i];
    dropped[i] = c.inside && !c.at_wall && c.volume < options.drop_below;
  }
  std::vector<std::array<int32_t, 2>> next_to; // (inside part, outside part)
  for (size_t t = 0; t < elements.tri.size(); ++t)
    if (elements.boundary[t] == surface)
      next_to.push_back(
          {found.of_vertex[at(elements.tri_sides[t][0])], found.of_vertex[at(elements.tri_sides[t][1])]});
  par::sort_unique(next_to, 1);
  for (size_t i = 0; i < dropped.size(); ++i)
    if (dropped[i])
      found.component[i].region = cavity;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [in, out] : next_to) {
      Component &a = found.component[at(in)], &b = found.component[at(out)];
      if (!dropped[at(in)])
        continue;
      if (a.region == outside && b.region == cavity)
        b.region = outside, changed = true;
      if (b.region == outside && a.region == cavity)
        a.region = outside, changed = true;
    }
  }
}

} // namespace

Components find_components(const ComplexView& c, const Elements& elements, const RegionOptions& options,
                           int threads) {
  const Sets sets = join_leaves(c, threads);
  Components found;
  found.of_vertex.resize(at(c.vertices()));
  // Every part has a grid point, and the lowest vertex of a part names it.
  const LargeArray<int32_t> root =
      par::select(c.grid_vertices, threads, [&](int64_t v) { return sets.find(static_cast<int32_t>(v)) == v; });
  for (int32_t v : root)
    found.component.push_back({c.inside(v), false, 0, 0});
  par::for_n(c.vertices(), threads, [&](int64_t i) {
    const auto v = static_cast<int32_t>(i);
    const int32_t leaf = c.leaf_of(v);
    const bool known = leaf < 0 || c.split[leaf] == v; // grid points, centres of split cells
    found.of_vertex[at(i)] =
        known ? static_cast<int32_t>(std::lower_bound(root.begin(), root.end(), sets.find(v)) - root.begin()) : -1;
  });
  const Vec3i cells = c.lattice.cells;
  for (int32_t v : par::select(c.grid_vertices, threads, [&](int64_t i) {
         const Vec3i p = c.point[i];
         return p.x == 0 || p.y == 0 || p.z == 0 || p.x == cells.x || p.y == cells.y || p.z == cells.z;
       }))
    found.component[at(found.of_vertex[at(v)])].at_wall = true;

  // Volume by the divergence theorem, over the triangles that close the part.
  const Vec3d origin = c.lattice.position({0, 0, 0});
  for (size_t t = 0; t < elements.tri.size(); ++t) {
    const Tri& tri = elements.tri[t];
    const double v = tet_volume(origin, elements.position[at(tri[0])], elements.position[at(tri[1])],
                                elements.position[at(tri[2])]);
    const auto [behind, front] = elements.tri_sides[t];
    found.component[at(found.of_vertex[at(behind)])].volume += v;
    if (behind != front)
      found.component[at(found.of_vertex[at(front)])].volume -= v;
  }
  for (Component& part : found.component)
    if (!part.inside && part.at_wall)
      part.volume = 0;
  assign_regions(found, elements, options);
  return found;
}

} // namespace molmesh::contour
