// components.cpp — union-find over the vertices of the complex.
#include "contour/components.hpp"
#include "contour/detail/at.hpp"
#include "geom/tet_measures.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <numeric>

namespace molmesh::contour {

using detail::at;
namespace {

class Sets {
public:
  explicit Sets(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int32_t find(int32_t i) {
    while (parent_[at(i)] != i)
      i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }
  /// The lower vertex names the set.
  void join(int32_t a, int32_t b) {
    a = find(a), b = find(b);
    if (a != b)
      parent_[at(std::max(a, b))] = std::min(a, b);
  }

private:
  std::vector<int32_t> parent_;
};

void join_leaf(const Complex& c, int32_t leaf, Sets& sets) {
  const auto vertex = [&](int k) { return c.grid_vertex[at(int64_t{8} * leaf + k)]; };
  const auto join_if_same = [&](int32_t a, int32_t b) {
    if (c.inside(a) == c.inside(b))
      sets.join(a, b);
  };
  if (c.side[at(leaf)] != Side::crossed) {
    for (int k = 1; k < 8; ++k)
      sets.join(vertex(0), vertex(k));
    return;
  }
  for (int k = 0; k < 8; ++k)
    for (int bit = 1; bit < 8; bit *= 2)
      if (!(k & bit))
        join_if_same(vertex(k), vertex(k | bit));
  if (c.tree.level[at(leaf)] > 0)
    return;
  const CellTopology t = c.topology(leaf);
  for (int f = 0; f < 6; ++f)
    if (t.diagonal[at(f)] != Diagonal::none) {
      const auto [a, b] = diagonal_corners(f, t.diagonal[at(f)]);
      sets.join(vertex(a), vertex(b));
    }
  if (c.is_split(leaf))
    for (int k = 0; k < 8; ++k)
      if (k != t.chop)
        join_if_same(vertex(k), c.split[at(leaf)]);
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

Components find_components(const Complex& c, const Elements& elements, const RegionOptions& options) {
  Sets sets(c.position.size());
  for (int32_t leaf = 0; leaf < c.tree.size(); ++leaf)
    join_leaf(c, leaf, sets);

  Components found;
  found.of_vertex.assign(c.position.size(), -1);
  const auto number = [&](int32_t v) {
    const int32_t root = sets.find(v);
    int32_t& id = found.of_vertex[at(root)];
    if (id < 0) {
      id = static_cast<int32_t>(found.component.size());
      found.component.push_back({c.inside(root), false, 0, 0});
    }
    found.of_vertex[at(v)] = id;
    return id;
  };
  const Vec3i cells = c.lattice.cells;
  for (int32_t v = 0; v < c.grid_vertices; ++v) {
    Component& part = found.component[at(number(v))];
    const Vec3i p = c.point[at(v)];
    for (int a = 0; a < 3; ++a)
      part.at_wall = part.at_wall || p[a] == 0 || p[a] == cells[a];
  }
  for (int32_t leaf = 0; leaf < c.tree.size(); ++leaf)
    if (c.is_split(leaf))
      number(c.split[at(leaf)]);

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
