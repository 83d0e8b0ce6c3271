// part_copy.hpp — copies a part of a mesh, so that operations can be tried without changing it.
#pragma once
#include "optimize/mesh/dynamic_mesh.hpp"
#include "optimize/mesh/parts.hpp"
#include "optimize/mesh/snapshot.hpp"
#include <algorithm>
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// Elements and vertices have other numbers in the same order: an operation does there what it would do in the
/// mesh. Surface triangles beyond the part are not known.
struct PartCopy {
  DynamicMesh mesh; ///< elements of the part, their neighbours, and the reserved slots
  Parts parts;
  PartRoom room;
  std::vector<int32_t> slots;   ///< as given
  std::vector<int32_t> element; ///< [elements] their numbers in the mesh, ascending

  int32_t number(int32_t mesh_element) const {
    return static_cast<int32_t>(std::lower_bound(element.begin(), element.end(), mesh_element) - element.begin());
  }
};

/// slots: every slot that may hold an element of the part.
PartCopy copy_part(const DynamicMesh& mesh, const Parts& parts, const PartRoom& room,
                   const std::vector<int32_t>& slots);

} // namespace molmesh::optimize
