// merging.hpp — how coarse the octree may be at each surface cell.
#pragma once
#include "contour/lattice.hpp"
#include "contour/surface_cells.hpp"
#include "contour/surface_sample.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::contour {

/// For each surface cell the highest level at which the octree's node round it may be one cell: all its surface
/// is one sheet, within `adapt` fine spacings of its mean plane, and merging keeps the topology: every child may be
/// one cell, and the signs at the middles of its edges, faces and volume each agree with a corner of that edge,
/// face or volume (Ju et al. 2002, the paper's reference 22). adapt 0: none merges.
std::vector<int8_t> merge_levels(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                                 const std::vector<SurfaceSample>& samples, double adapt, int threads);

/// First surface cell of each of the octree's nodes of a level, then their number.
std::vector<int64_t> node_ranges(const std::vector<SurfaceCell>& cells, int level);

} // namespace molmesh::contour
