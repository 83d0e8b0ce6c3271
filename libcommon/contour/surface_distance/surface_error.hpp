// surface_error.hpp — how far the surface of a mesh is from the isosurface.
#pragma once
#include "grid/block_grid.hpp"
#include "mesh/tet_mesh.hpp"

namespace molmesh::contour {

/// Distances of the centroids of molecular-surface triangles from the isosurface, Å; rms: over the area. Bounds, in
/// pinches where no foot is found, they are bounds by way of a corner.
struct SurfaceError {
  double worst = 0, rms = 0;
};

/// Same result for any number of threads.
SurfaceError surface_error(const TetMesh& mesh, const BlockGrid& grid, int threads);

} // namespace molmesh::contour
