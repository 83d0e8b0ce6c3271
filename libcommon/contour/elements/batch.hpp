// batch.hpp — the elements of one run of leaves, or of edges, before all runs are joined.
#pragma once
#include "base/error.hpp"
#include "geom/vec.hpp"
#include "mesh/tet_mesh.hpp"
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace molmesh::contour {

inline constexpr int32_t no_vertex = std::numeric_limits<int32_t>::min();

/// One face met by a sign-change edge: going round the edge from its inside to its outside end, the ring of dual
/// vertices runs from → (via) → to. At a wall, from or to is the wall point.
struct Link {
  int32_t inside, outside;
  int32_t from, via, to;
  MOLMESH_HD bool same_edge(const Link& o) const { return inside == o.inside && outside == o.outside; }
  bool operator<(const Link& o) const {
    return inside != o.inside ? inside < o.inside : outside != o.outside ? outside < o.outside : from < o.from;
  }
};

/// Elements, and the links of faces. New points are numbered -1, -2 … until the batches are joined.
struct BatchData {
  std::vector<Tet> tet;
  std::vector<Tri> tri;
  std::vector<std::array<int32_t, 2>> tri_sides;
  std::vector<int32_t> boundary;
  std::vector<Link> link;
  std::vector<Vec3d> point;
  std::vector<int32_t> point_wall; ///< Boundary of a wall point, 0 otherwise
  std::vector<int32_t> spoiled;    ///< see Batch

  int32_t add_point(Vec3d p, int32_t wall) {
    point.push_back(p);
    point_wall.push_back(wall);
    return -static_cast<int32_t>(point.size());
  }
  [[noreturn]] void broken_ring() { fail(Status::failed, "contour: a sign-change edge without a ring"); }
  /// behind, front: a vertex of the complex on either side of a surface triangle; equal on a wall.
  void add_triangle(Tri t, int32_t behind, int32_t front, int32_t label) {
    tri.push_back(t);
    tri_sides.push_back({behind, front});
    boundary.push_back(label);
  }
  /// Empty, but with its memory.
  void clear() {
    tet.clear();
    tri.clear();
    tri_sides.clear();
    boundary.clear();
    link.clear();
    point.clear();
    point_wall.clear();
    spoiled.clear();
  }
};

/// check: no elements, but the vertices of the complex that those without positive volume would hang on.
template <bool check>
struct Batch : BatchData {
  static constexpr bool checks = check;
};

} // namespace molmesh::contour
