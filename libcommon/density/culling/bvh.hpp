// bvh.hpp — a bounding volume hierarchy finds the clusters of atoms near each brick (§3.2 of Liao et al. 2013).
// Every cluster has the box of its atoms' centres and its own cutoff distance (R_BVH, field/cutoff.hpp). The
// hierarchy is that of the grid: cubes are halved down to bricks, and each half keeps the clusters of its parent
// that are near. The device descends the molecule's own hierarchy of boxes instead (cuda/density/bvh.hpp).
#pragma once
#include "density/culling/bricks.hpp"

namespace molmesh::density {

/// Of the bricks with blocks in `range`, those that have clusters nearer than their cutoff; with `every` all. Same
/// list at any number of threads. Throws std::bad_alloc early if the list is sure to exceed the memory.
BrickList bricks_by_bvh(const Field& f, const GridFrame& frame, const BlockRange& range, bool every, int threads);

} // namespace molmesh::density
