// outer_sphere.hpp — the sphere that a mesh ends at, where it follows from the molecule's surface.
#pragma once
#include "contour/octree/lattice.hpp"
#include "grid/block_grid.hpp"

namespace molmesh::contour {

/// About the middle of the surface's bounding box, out to the surface's farthest point. Both are taken of the
/// points where the surface crosses the grid's edges. Throws Error(failed) where the grid has no surface.
Sphere sphere_round_surface(const BlockGrid& grid, int threads);

/// sphere_factor and sphere_padding become sphere; others stay.
BoxRequest with_sphere(const BlockGrid& grid, BoxRequest request, int threads);

} // namespace molmesh::contour
