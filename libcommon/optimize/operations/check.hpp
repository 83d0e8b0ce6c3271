// check.hpp — what is wrong with a part of a mesh between two operations, and the part as a mesh to look at.
#pragma once
#include "optimize/operations/region.hpp"
#include <string>

namespace molmesh::optimize {

/// The first element of the region whose volume, quality, neighbours, labels or vertices are wrong; empty: none.
std::string find_fault(const Region& r);

/// The elements of the region with their surface triangles: a mesh to look at, open where the part ends.
TetMesh as_mesh(const Region& r);

} // namespace molmesh::optimize
