// times.hpp — the stages timed, in seconds and in shares of the card's peaks.
#pragma once
#include "stages.hpp"

namespace molmesh::gpu {

/// Prints. device: on the GPU, or host_as_device, then without shares. reference: contouring by the host.
void time_all(const Hierarchy& h, const density::Options& o, int repeats, const How& device, const How& reference);

} // namespace molmesh::gpu
