// times.hpp — the stages timed, in seconds and in shares of the card's peaks.
#pragma once
#include "stages.hpp"

namespace molmesh::gpu {

/// Prints. last: the stages up to it. device: on the GPU, or host_as_device, then without shares. reference:
/// contouring by the host. A mesh that cannot be made is told of, and the others are timed.
void time_all(const Hierarchy& h, const density::Options& o, Stage last, int repeats, const How& device,
              const How& reference);

} // namespace molmesh::gpu
