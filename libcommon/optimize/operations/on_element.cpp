// on_element.cpp — operations in turn until one is done.
#include "optimize/operations/on_element.hpp"
#include "optimize/acceptance/surface_fit.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace molmesh::optimize {

namespace {

/// The shape of a bad element says which of its edges may help.
struct Shape {
  std::array<size_t, 6> order{0, 1, 2, 3, 4, 5}; ///< of `edges`: by_length: the shortest first
  std::array<bool, 6> acute{};                   ///< the dihedral angle there is, by far: such edges seldom go

  Shape(const DynamicMesh& m, const Element& e, bool by_length) {
    if (!by_length)
      return;
    constexpr double far = 0.82; // cosine
    std::array<Vec3d, 4> p, normal;
    for (size_t i = 0; i < 4; ++i)
      p[i] = m.point[e.v[i]];
    for (size_t f = 0; f < 4; ++f) {
      const auto v = outward_triangle({0, 1, 2, 3}, f);
      normal[f] = cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]);
    }
    std::array<double, 6> length;
    for (size_t k = 0; k < edges.size(); ++k) {
      const auto& [i, j] = edges[k];
      const Vec3d &a = normal[edges[5 - k][0]], &b = normal[edges[5 - k][1]]; // of the faces at the edge
      length[k] = norm2(p[i] - p[j]);
      acute[k] = -dot(a, b) > far * std::sqrt(norm2(a) * norm2(b));
    }
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return length[a] < length[b]; });
  }
};

} // namespace

bool improve_element(Region& r, const Acceptance& accept, int32_t t, bool merges_and_splits) {
  const auto element = [&]() -> const Element& { return r.mesh.element[t]; };
  const auto contract = [&](int i, int j) {
    return contract_edge(r, accept, t, i, j) || contract_edge(r, accept, t, j, i);
  };
  if (accept.tiny_share < 1)
    for (const auto& [i, j] : edges)
      if (is_tiny(r, t, i, j) && contract(i, j))
        return true;
  const Shape shape(r.mesh, element(), !accept.thorough);
  for (size_t k = 0; k < edges.size(); ++k)
    if (!shape.acute[k] && remove_edge(r, accept, t, edges[k][0], edges[k][1]))
      return true;
  for (int f = 0; f < 4; ++f)
    if (swap_face(r, accept, t, f))
      return true;
  const float q = element().q;
  bool done = false;
  const auto smooth = [&](auto&& choose) {
    for (size_t i = 0; i < 4; ++i)
      if (choose(r.mesh.vertex[element().v[i]].kind == Kind::interior)) {
        done |= smooth_vertex(r, accept, element().v[i]);
        if (element().q >= accept.goal)
          return true;
      }
    return false;
  };
  if (accept.thorough ? smooth([](bool) { return true; }) // Inside it costs half as much, and helps twice as often.
                      : smooth([](bool inside) { return inside; }) || smooth([](bool inside) { return !inside; }))
    return true;
  if (element().q > 1.05f * q)
    return true;
  // Nine of ten contractions and merges are of the two shortest edges, and splits of the three longest ones.
  const auto any_edge = [&](size_t first, size_t end, auto&& operation) {
    for (size_t k = accept.thorough ? 0 : first; k < (accept.thorough ? 6 : end); ++k)
      if (const auto& [i, j] = edges[shape.order[k]]; operation(i, j))
        return true;
    return false;
  };
  if (any_edge(0, 2, contract))
    return true;
  return (merges_and_splits && (any_edge(0, 2, [&](int i, int j) { return merge_edge(r, accept, t, i, j); }) ||
                                any_edge(3, 6, [&](int i, int j) { return split_edge(r, accept, t, i, j); }))) ||
         done;
}

void fit_element(Region& r, const Acceptance& accept, int32_t t) {
  const auto vertex = [&](int i) { return r.mesh.element[t].v[i]; };
  for (int f = 0; f < 4; ++f) {
    if (!is_bent(r, accept, t, size_t(f)))
      continue;
    const auto any_edge = [&](auto&& operation) {
      return std::any_of(std::begin(edges), std::end(edges),
                         [&](const auto& e) { return e[0] != f && e[1] != f && operation(e[0], e[1]); });
    };
    if (any_edge([&](int i, int j) { return remove_edge(r, accept, t, i, j); }))
      return;
    for (int i = 0; i < 4; ++i)
      if (i != f)
        smooth_vertex(r, accept, vertex(i));
    if (!is_bent(r, accept, t, size_t(f)))
      return;
    if (any_edge([&](int i, int j) {
          return contract_edge(r, accept, t, i, j) || contract_edge(r, accept, t, j, i) ||
                 merge_edge(r, accept, t, i, j);
        }) ||
        any_edge([&](int i, int j) { return split_edge(r, accept, t, i, j); }))
      return;
  }
  for (int i = 0; i < 4; ++i)
    if (off(r, vertex(i)) > 1)
      smooth_vertex(r, accept, vertex(i));
}

void sort_worst_first(const DynamicMesh& m, std::vector<int32_t>& list) {
  std::sort(list.begin(), list.end(), [&](int32_t a, int32_t b) {
    const float qa = m.element[a].q, qb = m.element[b].q;
    return qa != qb ? qa < qb : a < b;
  });
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

} // namespace molmesh::optimize
