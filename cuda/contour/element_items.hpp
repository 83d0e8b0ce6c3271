// element_items.hpp — kernels that make the elements of faces and rings twice: counted, then written where the sums
// of the counts say. Nothing is appended, so the order is that of leaves and edges.
#pragma once
#include "contour/complex/complex_passes.hpp"
#include "contour/elements/interior_edges.hpp"
#include "contour/elements/sign_change_edges.hpp"
#include "par/items.hpp"

namespace molmesh::cuda {

using contour::ComplexView;
using contour::Link;
using Sides = std::array<int32_t, 2>;

/// Takes what a vector's push_back takes: counts, and writes where there is a place.
template <class T>
struct Sink {
  T* to;
  int32_t n;
  MOLMESH_HD void push_back(const T& v) {
    if (to)
      to[n] = v;
    ++n;
  }
};

/// Vertices that elements without positive volume hang on, as flags.
struct SpoiledSink {
  uint8_t* flag;
  MOLMESH_HD void push_back(int32_t vertex) const { par::raise(flag[vertex]); }
};

/// contour::Batch for one item.
template <bool check>
struct ItemOut {
  static constexpr bool checks = check;
  Sink<Tet> tet;
  Sink<Tri> tri;
  Sides* tri_sides;
  int32_t* boundary;
  Sink<Link> link;
  Sink<Vec3d> point;
  int32_t* wall;
  SpoiledSink spoiled;
  int32_t number; ///< of the item's first new point
  int32_t broken;

  MOLMESH_HD int32_t add_point(Vec3d p, int32_t at_wall) {
    if (wall)
      wall[point.n] = at_wall;
    point.push_back(p);
    return number + point.n - 1;
  }
  MOLMESH_HD void add_triangle(Tri t, int32_t behind, int32_t front, int32_t label) {
    if (tri.to) {
      tri_sides[tri.n] = {behind, front};
      boundary[tri.n] = label;
    }
    tri.push_back(t);
  }
  MOLMESH_HD void broken_ring() { ++broken; }
};

/// Per item, then scanned: one more slot each for the total.
struct ItemCounts {
  int32_t *tet, *tri, *link, *point, *broken;
};
/// Where a run of items writes; null: nowhere.
struct ItemPlaces {
  Tet* tet;
  Tri* tri;
  Sides* tri_sides;
  int32_t* boundary;
  Link* link;
  Vec3d* point;
  int32_t* wall;
  int32_t number; ///< of the run's first new point
};

/// Make: make(item, out). order: items by their work, so that neighbours in a warp have about as much to do.
/// Counts, or with places and scanned counts writes: one kernel, since its body is large.
template <class Make>
struct RunElements {
  Make make;
  int64_t first;
  const uint32_t* order;
  ItemCounts count;
  ItemPlaces to;
  uint8_t* spoiled; ///< [vertices], where elements are only checked
  MOLMESH_HD void operator()(int64_t n) const {
    const int64_t i = order[n];
    ItemOut<Make::check> out{};
    out.number = int32_t{1} << 30; // no number of an old vertex, and not negative
    if (to.link)
      out = {{to.tet + count.tet[i], 0},   {to.tri + count.tri[i], 0},
             to.tri_sides + count.tri[i],  to.boundary + count.tri[i],
             {to.link + count.link[i], 0}, {to.point + count.point[i], 0},
             to.wall + count.point[i],     {},
             to.number + count.point[i],   0};
    out.spoiled.flag = spoiled;
    make(first + i, out);
    if (to.link)
      return;
    count.tet[i] = out.tet.n;
    count.tri[i] = out.tri.n;
    count.link[i] = out.link.n;
    count.point[i] = out.point.n;
    count.broken[i] = out.broken;
  }
};

template <bool only_check>
struct MakeFaces {
  static constexpr bool check = only_check;
  ComplexView c;
  const int32_t* leaves; ///< null: all
  MOLMESH_HD int32_t leaf(int64_t i) const { return leaves ? leaves[i] : static_cast<int32_t>(i); }
  MOLMESH_HD void operator()(int64_t i, ItemOut<check>& out) const {
    contour::NearLeaves near(c.tree);
    contour::make_faces(c, near, leaf(i), out);
  }
  /// Leaves of one level, and surface cells apart: similar work (§4.2).
  MOLMESH_HD uint32_t work(int64_t i) const {
    const int32_t l = leaf(i);
    return uint32_t(c.tree.level[l]) * 4 + uint32_t(c.side[l] == contour::Side::crossed) * 2 +
           uint32_t(c.is_split(l));
  }
};

/// Links of edge e: [first[e], first[e + 1]).
template <bool only_check>
struct MakeRings {
  static constexpr bool check = only_check;
  contour::RingVertices vertices;
  const Link* link;
  const int64_t* first;
  MOLMESH_HD void operator()(int64_t e, ItemOut<check>& out) const {
    contour::make_ring(vertices, link + first[e], link + first[e + 1], out);
  }
  MOLMESH_HD uint32_t work(int64_t e) const { return uint32_t(first[e + 1] - first[e]); }
};

template <class Make>
struct WorkKeys {
  Make make;
  int64_t first;
  uint32_t *key, *order;
  MOLMESH_HD void operator()(int64_t i) const {
    key[i] = ~make.work(first + i); // most first
    order[i] = uint32_t(i);
  }
};

/// Links of edges with both ends among `ends`, ascending, or not grid points.
struct WholeEdges {
  const Link* link;
  const int32_t* ends;
  int64_t n;
  int32_t grid_vertices;
  MOLMESH_HD int64_t operator()(int64_t i, Link* out) const {
    if (!is_end(link[i].inside) || !is_end(link[i].outside))
      return 0;
    if (out)
      *out = link[i];
    return 1;
  }

private:
  MOLMESH_HD bool is_end(int32_t v) const { // all faces at a split cell's centre are that cell's
    int64_t begin = 0, end = n;
    while (begin < end) {
      const int64_t middle = (begin + end) / 2;
      if (ends[middle] < v)
        begin = middle + 1;
      else
        end = middle;
    }
    return v >= grid_vertices || (begin < n && ends[begin] == v);
  }
};
/// Links in order: by where they come from, then, keeping that, by edge.
struct LinkFrom {
  const Link* link;
  uint32_t *key, *index;
  MOLMESH_HD void operator()(int64_t i) const {
    key[i] = uint32_t(link[i].from);
    index[i] = uint32_t(i);
  }
};
struct LinkEdge {
  const Link* link;
  const uint32_t* index;
  uint64_t* key;
  MOLMESH_HD void operator()(int64_t i) const {
    const Link& l = link[index[i]];
    key[i] = uint64_t(uint32_t(l.inside)) << 32 | uint32_t(l.outside);
  }
};
struct FirstLink {
  const Link* link;
  int64_t *first, *index;
  MOLMESH_HD void operator()(int64_t i) const {
    first[i] = i == 0 || !link[i].same_edge(link[i - 1]);
    index[i] = i;
  }
};

} // namespace molmesh::cuda
