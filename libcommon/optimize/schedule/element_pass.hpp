// element_pass.hpp — the order of operations on one element.
#pragma once
#include "optimize/schedule/schedule.hpp"
#include <array>

namespace molmesh::optimize {

/// Of an element: the corners of its edges.
inline constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// One operation on a bad element, the cheap and local ones first. True when something was done.
bool improve_element(Editor& editor, const DynamicMesh& m, int32_t t, const Pass& pass);

/// One operation on each bent face of an element and on each vertex off the target, the editor straightening.
void straighten_element(Editor& editor, const DynamicMesh& m, int32_t t);

/// Ascending by quality, then number; each once.
void sort_worst_first(const DynamicMesh& m, std::vector<int32_t>& list);

} // namespace molmesh::optimize
