// cpus.hpp — how many threads can run at a time.
#pragma once
#include "base/control_groups.hpp"

namespace molmesh::cli {

/// The processors' time that control groups grant, in processors, a part of one as one; the system itself may have
/// fewer. -1: no limit. More threads would wait for each other's time.
int cpus_granted(const SystemFiles& system = {});

/// As many threads as OpenMP would use, and no more than are granted unless OMP_NUM_THREADS says so.
int default_threads();

} // namespace molmesh::cli
