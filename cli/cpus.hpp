// cpus.hpp — how many threads can run at a time, and whether they can be started.
#pragma once
#include "base/control_groups.hpp"

namespace molmesh::cli {

/// The processors' time that control groups grant, in processors, a part of one as one; the system itself may have
/// fewer. -1: no limit. More threads would wait for each other's time.
int cpus_granted(const SystemFiles& system = {});

/// As many threads as OpenMP would use, and no more than are granted unless OMP_NUM_THREADS says so.
int default_threads();

/// Throws Error(failed) where the system does not start so many threads: OpenMP's own answer to that is the end of
/// the process. Where addresses are limited (ulimit -v) they are started for good, before memory is taken for
/// anything else.
void require_threads(int threads);

} // namespace molmesh::cli
