// optimize.hpp — a better tetrahedral mesh on a GPU.
#pragma once
#include "cuda/par/backend.hpp"
#include "optimize/optimize.hpp"

namespace molmesh::cuda {

/// optimize::improve with sweeps of geometric flow on the GPU before each round; the topological passes stay on
/// options.threads threads of the host. Without a density, points of curved surfaces stay in the flow. Memory as in
/// contour_mesh. Throws Error(mode_unavailable) where there is no GPU.
optimize::Result improve_mesh(TetMesh& mesh, const BlockGrid* density, const optimize::Options& options,
                              const std::function<void(const std::string&)>& phase, DeviceReport& report,
                              int64_t most_bytes = 0);

/// Sweeps in a round: the more there are, the longer the host's passes take after them (docs/experiments.md).
inline constexpr int flow_sweeps = 2;

} // namespace molmesh::cuda
