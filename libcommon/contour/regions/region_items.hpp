// region_items.hpp — kernels that join vertices into connected components and sum the volumes these enclose. Host
// and device.
#pragma once
#include "contour/complex/complex.hpp"
#include "contour/elements/elements.hpp"
#include "geom/tet_measures.hpp"
#include "par/atomic_updates.hpp"

namespace molmesh::contour {

/// Union-find for any number of threads at once: higher vertices hang under lower ones, so the lowest of a set
/// names it in the end, in whatever order the sets were joined.
struct Sets {
  uint32_t* parent;

  MOLMESH_HD uint32_t find(uint32_t v) const {
    for (uint32_t p = par::seen(parent[v]); p != v; p = par::seen(parent[v])) {
      const uint32_t above = par::seen(parent[p]);
      if (above != p)
        par::put(parent[v], above);
      v = above;
    }
    return v;
  }
  MOLMESH_HD void join(uint32_t a, uint32_t b) const {
    for (a = find(a), b = find(b); a != b; a = find(a), b = find(b)) {
      const uint32_t high = a > b ? a : b, low = a > b ? b : a, was = par::lower(parent[high], low);
      if (was == high)
        return;
      a = low; // another thread was first: what `high` hung under belongs to the set too
      b = was;
    }
  }
};
struct StartSets {
  uint32_t* parent;
  MOLMESH_HD void operator()(int64_t v) const { parent[v] = static_cast<uint32_t>(v); }
};

/// Joins the leaf's vertices that lie in one component.
struct JoinLeaves {
  ComplexView c;
  Sets sets;

  MOLMESH_HD void operator()(int64_t i) const {
    const auto leaf = static_cast<int32_t>(i);
    if (c.side[leaf] != Side::crossed) {
      for (int k = 1; k < 8; ++k)
        join(vertex(leaf, 0), vertex(leaf, k));
      return;
    }
    for (int k = 0; k < 8; ++k)
      for (int bit = 1; bit < 8; bit *= 2)
        if (!(k & bit))
          join_if_same(vertex(leaf, k), vertex(leaf, k | bit));
    if (c.tree.level[leaf] > 0)
      return;
    const CellTopology t = c.topology(leaf);
    for (int f = 0; f < 6; ++f)
      if (const Diagonal d = t.diagonal[f]; d != Diagonal::none) {
        const auto [a, b] = diagonal_corners(f, d);
        join(vertex(leaf, a), vertex(leaf, b));
      }
    if (c.is_split(leaf))
      for (int k = 0; k < 8; ++k)
        if (k != t.chop)
          join_if_same(vertex(leaf, k), c.split[leaf]);
  }

private:
  MOLMESH_HD int32_t vertex(int32_t leaf, int k) const { return c.corner_vertex(leaf, k); }
  MOLMESH_HD void join(int32_t a, int32_t b) const {
    sets.join(static_cast<uint32_t>(a), static_cast<uint32_t>(b));
  }
  MOLMESH_HD void join_if_same(int32_t a, int32_t b) const {
    if (c.inside(a) == c.inside(b))
      join(a, b);
  }
};

/// What is known of a component before its surface is looked at.
struct ComponentStart {
  int32_t vertex; ///< its lowest
  int32_t inside; ///< 1 or 0: no byte of it is left unwritten
};
/// Of grid points: every component has one, and its lowest vertex names it.
struct GatherComponents {
  ComplexView c;
  const uint32_t* parent;
  MOLMESH_HD int64_t operator()(int64_t v, ComponentStart* out) const {
    if (parent[v] != v)
      return 0;
    if (out)
      *out = {static_cast<int32_t>(v), c.inside(static_cast<int32_t>(v)) ? 1 : 0};
    return 1;
  }
};
struct NumberComponents {
  const ComponentStart* start;
  int32_t* part;
  MOLMESH_HD void operator()(int64_t i) const { par::put(part[start[i].vertex], static_cast<int32_t>(i)); }
};
/// part: [vertices] those that name a component have its number; -1 for dual vertices. at_wall: [components]
struct LabelComponents {
  ComplexView c;
  Sets sets;
  int32_t* part;
  uint8_t* at_wall;
  MOLMESH_HD void operator()(int64_t i) const {
    const auto v = static_cast<int32_t>(i);
    const int32_t leaf = c.leaf_of(v);
    if (leaf >= 0 && c.split[leaf] != v) // neither a grid point nor a split cell's centre
      return par::put(part[v], -1);
    const int32_t p = par::seen(part[sets.find(static_cast<uint32_t>(v))]);
    par::put(part[v], p);
    if (v < c.grid_vertices && c.at_wall(v) && !par::seen(at_wall[p]))
      par::raise(at_wall[p]);
  }
};

/// A run of triangles between two components, or of one component's at the wall: behind == front.
struct ComponentSurface {
  int32_t behind, front;
  double volume; ///< Å³ between them and the origin
};
/// Volume by the divergence theorem, in runs of so many triangles at most: sums keep their order.
struct ComponentSurfaces {
  static constexpr int64_t run = 64;
  ElementsView e;
  const int32_t* part;
  LatticeView lattice;
  /// The grid's first point: a far wall's corner would leave a small component's volume to rounding.
  MOLMESH_HD Vec3d origin() const {
    Vec3i p;
    for (int a = 0; a < 3; ++a)
      p[a] = lattice.grid_first[a] < 0                  ? 0
             : lattice.grid_first[a] > lattice.cells[a] ? lattice.cells[a]
                                                        : lattice.grid_first[a];
    return lattice.position(p);
  }
  MOLMESH_HD int64_t operator()(int64_t i, ComponentSurface* out) const {
    const Vec3d from = origin();
    ComponentSurface now{-1, -1, 0};
    int64_t n = 0;
    for (int64_t t = run * i; t < run * (i + 1) && t < e.tris; ++t) {
      const int32_t behind = part[e.tri_sides[t][0]], front = part[e.tri_sides[t][1]];
      if (n == 0 || behind != now.behind || front != now.front) {
        if (n > 0 && out)
          out[n - 1] = now;
        now = {behind, front, 0};
        ++n;
      }
      if (out)
        now.volume += tet_volume(from, e.position[e.tri[t][0]], e.position[e.tri[t][1]], e.position[e.tri[t][2]]);
    }
    if (n > 0 && out)
      out[n - 1] = now;
    return n;
  }
};

/// The Region of a component, for its vertices; 0 for dual vertices.
struct SetRegions {
  const int32_t* part;
  const uint8_t* region_of;
  uint8_t* region;
  MOLMESH_HD void operator()(int64_t v) const { region[v] = part[v] < 0 ? uint8_t{0} : region_of[part[v]]; }
};

} // namespace molmesh::contour
