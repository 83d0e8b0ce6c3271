// heal.hpp — elements of one part that rounds leave below the goal, shaken until they come over it.
#pragma once
#include "optimize/operations/editor.hpp"
#include "optimize/schedule/pass.hpp"
#include "par/helpers.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// As recover_part. Where no fewer elements are below the goal, the worst of them is worse, or more points are off
/// the target or more triangles bent, the part is put back as it was.
void heal_part(Editor& editor, DynamicMesh& m, std::vector<int32_t> slots, const Pass& pass, int32_t time,
               par::Helpers& helpers);

} // namespace molmesh::optimize
