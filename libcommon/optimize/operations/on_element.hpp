// on_element.hpp — the order of operations on one element.
#pragma once
#include "optimize/operations/operations.hpp"
#include <vector>

namespace molmesh::optimize {

/// One operation on an element below the goal, the cheap and local ones first. merges_and_splits: these too. True
/// when something was done.
bool improve_element(Region& r, const Acceptance& accept, int32_t t, bool merges_and_splits);

/// One operation on each bent face of an element and on each vertex off the target, to fit the surface.
void fit_element(Region& r, const Acceptance& accept, int32_t t);

/// Ascending by quality, then number; each once.
void sort_worst_first(const DynamicMesh& m, std::vector<int32_t>& list);

} // namespace molmesh::optimize
