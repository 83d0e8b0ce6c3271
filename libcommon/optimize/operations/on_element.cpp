// on_element.cpp — operations in turn until one is done.
#include "optimize/operations/on_element.hpp"
#include "optimize/acceptance/surface_fit.hpp"
#include <algorithm>

namespace molmesh::optimize {

bool improve_element(Region& r, const Acceptance& accept, int32_t t, bool merges_and_splits) {
  const auto element = [&]() -> const Element& { return r.mesh.element[t]; };
  const auto contract = [&](int i, int j) {
    return contract_edge(r, accept, t, i, j) || contract_edge(r, accept, t, j, i);
  };
  if (accept.tiny_share < 1)
    for (const auto& [i, j] : edges)
      if (is_tiny(r, t, i, j) && contract(i, j))
        return true;
  for (const auto& [i, j] : edges)
    if (remove_edge(r, accept, t, i, j))
      return true;
  for (int f = 0; f < 4; ++f)
    if (swap_face(r, accept, t, f))
      return true;
  const float q = element().q;
  bool done = false;
  for (size_t i = 0; i < 4; ++i) {
    done |= smooth_vertex(r, accept, element().v[i]);
    if (element().q >= accept.goal)
      return true;
  }
  if (element().q > 1.05f * q)
    return true;
  for (const auto& [i, j] : edges)
    if (contract(i, j))
      return true;
  if (merges_and_splits) {
    for (const auto& [i, j] : edges)
      if (merge_edge(r, accept, t, i, j))
        return true;
    for (const auto& [i, j] : edges)
      if (split_edge(r, accept, t, i, j))
        return true;
  }
  return done;
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
