// recover.hpp — points of one part that are off the target come back, or leave the surface.
#pragma once
#include "optimize/operations/editor.hpp"
#include "optimize/schedule/pass.hpp"
#include "par/helpers.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// slots: all that elements of the part may be in. time: Editor::time. What does not leave the part better is put
/// back, with its counts. shaken: effort 2 is known to do nothing here, and effort 3 goes on from there. helpers:
/// threads for Mending::shake.
void recover_part(Editor& editor, DynamicMesh& m, std::vector<int32_t> slots, const Pass& pass, int32_t time,
                  bool shaken, par::Helpers& helpers);

} // namespace molmesh::optimize
