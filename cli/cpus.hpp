// cpus.hpp — how many threads can run at a time, and whether they can be started.
#pragma once
#include "base/control_groups.hpp"

namespace molmesh::cli {

/// The processors' time that control groups grant, in processors, a part of one as one; the system itself may have
/// fewer. -1: no limit. More threads would wait for each other's time.
int cpus_granted(const SystemFiles& system = {});

/// What a batch system's variable says, as SLURM_CPUS_PER_TASK: a whole number above zero, else -1. Null: not set.
int cpus_of_job(const char* text);

/// As many threads as OpenMP would use, and no more than control groups grant and SLURM_CPUS_PER_TASK says, unless
/// OMP_NUM_THREADS is set.
int default_threads();

/// As many of the threads, this one among them, as the system starts: OpenMP's own answer to one that does not
/// start is the end of the process. Where addresses are limited (ulimit -v) and all start, they are kept for OpenMP
/// before memory is taken for anything else.
int startable_threads(int wanted);

} // namespace molmesh::cli
