// refinement.hpp — which octree nodes must have children: where the surface needs its fine cells.
#pragma once
#include "contour/lattice.hpp"
#include "contour/octree.hpp"
#include "contour/surface_cells.hpp"
#include <vector>

namespace molmesh::contour {

struct RefineOptions {
  /// Allowed distance of a cell's fine surface from its mean plane, in fine spacings; 0: every surface cell stays
  /// fine and so does every cell of the grid in the regions below.
  double adapt = 0;
  bool inside = true, outside = true; ///< regions to mesh
};

/// A node with surface cells in it may be one cell only when its surface is one sheet near enough to a plane, and
/// when merging keeps the topology: every child may be one cell, and the signs at the middles of its edges, faces
/// and volume each agree with a corner of that edge, face or volume (Ju et al. 2002, the paper's reference 22).
RefinedNodes refine(const Lattice& lattice, const std::vector<SurfaceCell>& cells, const RefineOptions& options,
                    int threads);

/// Crossing of the surface with the straight line between two neighbouring values, as a share of the way from a to
/// b: log G is interpolated, since G falls exponentially. Kept away from both ends.
double crossing_share(double a, double b, double isovalue);

/// Surface of one fine cell: its mass centre (in fine spacings, lattice coordinates) and unit gradient.
struct SurfaceSample {
  Vec3d point, normal;
};
SurfaceSample surface_sample(const SurfaceCell& cell, double isovalue);

/// Mean of the surface's crossings with the cell's edges, in cell coordinates 0..1 (the paper's mass centre).
Vec3d mass_centre(const float value[8], double isovalue);

} // namespace molmesh::contour
