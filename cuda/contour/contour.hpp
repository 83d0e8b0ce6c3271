// contour.hpp — density2tet --mode cuda.
#pragma once
#include "contour/contour.hpp"
#include "cuda/par/backend.hpp"

namespace molmesh::cuda {

/// contour::contour with all stages on the GPU; those it has no room for on options.threads threads of the host,
/// which the report's note says. The lattice, and log G for the surface that vertices move along, are the host's.
/// Throws Error(mode_unavailable) where there is no GPU.
TetMesh contour_mesh(const BlockGrid& grid, const contour::Options& options, contour::Summary& summary,
                     const std::function<void(const std::string&)>& on_phase, DeviceReport& report);

} // namespace molmesh::cuda
