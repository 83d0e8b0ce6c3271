// contour.hpp — density2tet --mode cuda.
#pragma once
#include "contour/contour.hpp"
#include "cuda/par/backend.hpp"

namespace molmesh::cuda {

/// contour::contour with surface cells, samples, the selection of leaves, and the elements of all faces and of all
/// sign-change edges on the GPU; dual vertices and the rest stay on options.threads threads of the host. Throws
/// Error(mode_unavailable) where there is no GPU.
TetMesh contour_mesh(const BlockGrid& grid, const contour::Options& options, contour::Summary& summary,
                     const std::function<void(const std::string&)>& on_phase, DeviceReport& report);

} // namespace molmesh::cuda
