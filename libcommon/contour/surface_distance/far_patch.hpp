// far_patch.hpp — surface triangles that elements hold far from the isosurface, with the elements round them: a
// small mesh of its own, on the host, whose edges can be divided and joined again.
#pragma once
#include "mesh/tet_mesh.hpp"
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh::contour {

class FarPatch {
public:
  struct Element {
    int32_t at; ///< in the mesh; negative: not there yet
    Tet tet;    ///< vertices of the patch
    float quality;
    float weight; ///< 1, or unmeshed_weight
  };
  struct Triangle {
    int32_t at;     ///< as above
    int32_t parent; ///< in the mesh: which has its boundary and sides
    Tri tri;
    float off; ///< CentroidDistance
  };
  struct Edge {
    std::array<int32_t, 2> end;
    std::vector<size_t> elements, triangles; ///< all at it
  };

  std::vector<Element> element;
  std::vector<Triangle> triangle;
  std::vector<Vec3d> position;
  std::vector<uint8_t> is_free; ///< vertices off the surface and the walls that have all their elements here
  std::vector<int32_t> vertex;  ///< in the mesh, of those that are there

  /// When all of the above are there.
  void find_stars() {
    elements_.assign(position.size(), {});
    triangles_.assign(position.size(), {});
    for (size_t t = 0; t < element.size(); ++t)
      for (const int32_t v : element[t].tet)
        elements_[v].push_back(t);
    for (size_t t = 0; t < triangle.size(); ++t)
      for (const int32_t v : triangle[t].tri)
        triangles_[v].push_back(t);
  }
  const std::vector<size_t>& elements_at(int32_t v) const { return elements_[v]; }
  const std::vector<size_t>& triangles_at(int32_t v) const { return triangles_[v]; }

  /// Of surface triangle t, from corner i to the next.
  Edge edge(size_t t, size_t i) const {
    const Tri& v = triangle[t].tri;
    Edge e{{v[i], v[(i + 1) % 3]}, {}, {}};
    for (const size_t k : elements_at(e.end[0]))
      if (has(element[k].tet, e.end[1]))
        e.elements.push_back(k);
    for (const size_t k : triangles_at(e.end[0]))
      if (has(triangle[k].tri, e.end[1]))
        e.triangles.push_back(k);
    return e;
  }
  /// With a ring of elements and two triangles: not on a wall.
  bool is_divisible(const Edge& e) const {
    std::vector<int32_t> around;
    for (const size_t t : e.elements)
      for (const int32_t v : element[t].tet)
        if (v != e.end[0] && v != e.end[1])
          around.push_back(v);
    std::sort(around.begin(), around.end());
    bool closed = e.triangles.size() == 2;
    for (size_t i = 0; i < around.size(); i += 2)
      closed = closed && around[i] == around[i + 1];
    return closed;
  }

  /// By a new vertex, which is returned: each cell at the edge keeps its first end, and its other half is appended.
  int32_t divide(const Edge& e, Vec3d place) {
    const auto middle = static_cast<int32_t>(position.size());
    position.push_back(place);
    is_free.push_back(0);
    elements_.emplace_back();
    triangles_.emplace_back();
    for (const size_t t : e.elements) {
      Element half = element[t];
      half.at = -1;
      halve(element[t].tet, half.tet, e, middle, elements_, t, element.size());
      element.push_back(half);
    }
    for (const size_t t : e.triangles) {
      Triangle half = triangle[t];
      half.at = -1;
      halve(triangle[t].tri, half.tri, e, middle, triangles_, t, triangle.size());
      triangle.push_back(half);
    }
    return middle;
  }
  /// As it was before the last edge was divided, but for places, qualities and distances.
  void join(const Edge& e) {
    for (const size_t t : e.elements)
      unite(element[t].tet, e, elements_, t);
    for (const size_t t : e.triangles)
      unite(triangle[t].tri, e, triangles_, t);
    drop_last(e.elements.size(), element, elements_, [](const Element& c) { return c.tet; });
    drop_last(e.triangles.size(), triangle, triangles_, [](const Triangle& c) { return c.tri; });
    position.pop_back();
    is_free.pop_back();
    elements_.pop_back();
    triangles_.pop_back();
  }

private:
  using Stars = std::vector<std::vector<size_t>>;

  template <class Cell>
  static bool has(const Cell& cell, int32_t v) {
    return std::find(cell.begin(), cell.end(), v) != cell.end();
  }
  template <class Cell>
  static void halve(Cell& cell, Cell& half, const Edge& e, int32_t middle, Stars& stars, size_t t, size_t t_half) {
    std::replace(cell.begin(), cell.end(), e.end[1], middle);
    std::replace(half.begin(), half.end(), e.end[0], middle);
    std::erase(stars[e.end[1]], t);
    stars[middle].push_back(t);
    for (const int32_t v : half)
      stars[v].push_back(t_half);
  }
  template <class Cell>
  static void unite(Cell& cell, const Edge& e, Stars& stars, size_t t) {
    std::replace(cell.begin(), cell.end(), static_cast<int32_t>(stars.size()) - 1, e.end[1]);
    stars[e.end[1]].push_back(t);
  }
  template <class Cells, class Corners>
  static void drop_last(size_t n, Cells& cells, Stars& stars, Corners corners) {
    for (; n > 0; --n) {
      for (const int32_t v : corners(cells.back()))
        std::erase(stars[v], cells.size() - 1);
      cells.pop_back();
    }
  }

  Stars elements_, triangles_; ///< at each vertex
};

} // namespace molmesh::contour
