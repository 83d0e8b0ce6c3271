// search_part.hpp — one part of a mesh by one strategy.
#pragma once
#include "optimize/operations/region.hpp"
#include "optimize/search/strategy.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// slots: all that elements of the part may be in. What does not leave the part better is put back, with its
/// counts: Scope::points: fewer points are off, no more triangles bent than the moves allow for each, no more
/// elements below the goal and the worst of them no worse; Scope::elements: fewer elements below the goal, the
/// worst no worse, no more points off and no more triangles bent.
void search_part(Region& r, const std::vector<int32_t>& slots, const Strategy& strategy);

} // namespace molmesh::optimize
