// assembly.hpp — the mesh of the wanted regions, from the elements of all regions.
#pragma once
#include "contour/elements/elements.hpp"
#include "contour/options.hpp"
#include "contour/regions/components.hpp"
#include "mesh/tet_mesh.hpp"

namespace molmesh::contour {

/// Elements of the wanted regions, ordered by their first vertex of the complex, that is along the octree's curve;
/// points in the order in which these elements first use them.
TetMesh assemble(const Elements& elements, const Components& parts, Options::Meshed meshed, int threads);

} // namespace molmesh::contour
