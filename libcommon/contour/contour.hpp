// contour.hpp — density to a conforming tetrahedral mesh of the molecule, its surroundings, or both.
// Adaptive dual contouring, section 4 of Liao et al. 2013.
#pragma once
#include "contour/stages.hpp"
#include "grid/block_grid.hpp"
#include "mesh/tet_mesh.hpp"
#include <functional>
#include <string>

namespace molmesh::contour {

/// on_phase is called with the name of each phase as it starts. Throws Error(failed) when the grid has no surface,
/// the surface meets a wall that may not cut it, the region to mesh is empty, or leaves or elements are
/// more than can be numbered; Error(usage) for a box that cannot be had; Error(bad_input) for a grid whose band
/// leaves out corners of crossed cells.
TetMesh contour(const BlockGrid& grid, const Options& options, Summary& summary,
                const std::function<void(const std::string&)>& on_phase, Stages& stages);
/// On options.threads of the host.
TetMesh contour(const BlockGrid& grid, const Options& options, Summary& summary,
                const std::function<void(const std::string&)>& on_phase);

} // namespace molmesh::contour
