// contour.hpp — a density grid to tetrahedra on a GPU.
#pragma once
#include "contour/contour.hpp"
#include "cuda/par/backend.hpp"

namespace molmesh::cuda {

/// contour::contour with all stages on the GPU; what its memory has no room for is paged from the host's, which the
/// report's note says. The lattice, a halved grid where small bodies need one, and log G for the surface that
/// vertices move along are the host's.
/// most_bytes: of the GPU's memory that may be taken; 0: nine tenths of what is free.
/// Throws Error(mode_unavailable) where there is no GPU.
TetMesh contour_mesh(const BlockGrid& grid, const contour::Options& options, contour::Summary& summary,
                     const std::function<void(const std::string&)>& on_phase, DeviceReport& report,
                     int64_t most_bytes = 0);

} // namespace molmesh::cuda
