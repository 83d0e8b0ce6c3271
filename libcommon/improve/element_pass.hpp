// element_pass.hpp — the order of operations on one element.
#pragma once
#include "improve/schedule.hpp"

namespace molmesh::improve {

/// One operation on a bad element, the cheap and local ones first. True when something was done.
bool improve_element(Editor& editor, const DynamicMesh& m, int32_t t, const Pass& pass);

/// One operation on each bent face of an element and on each vertex off the target, the editor straightening.
void straighten_element(Editor& editor, const DynamicMesh& m, int32_t t);

/// Of elements, each once.
void sort_worst_first(const DynamicMesh& m, std::vector<int32_t>& list);

} // namespace molmesh::improve
