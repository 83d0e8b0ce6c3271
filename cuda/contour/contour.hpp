// contour.hpp — density2tet --mode cuda.
#pragma once
#include "contour/contour.hpp"
#include "cuda/par/backend.hpp"

namespace molmesh::cuda {

/// contour::contour with everything up to the relaxation made on the GPU: surface cells, samples, leaves, numbers
/// of grid points and their distances, dual vertices, points that go back, and all elements. The octree's hash,
/// relaxation, regions and assembly stay on options.threads threads of the host. Throws Error(mode_unavailable)
/// where there is no GPU.
TetMesh contour_mesh(const BlockGrid& grid, const contour::Options& options, contour::Summary& summary,
                     const std::function<void(const std::string&)>& on_phase, DeviceReport& report);

} // namespace molmesh::cuda
