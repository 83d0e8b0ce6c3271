// cpus.cpp — the cpu controllers of control groups, versions 1 and 2.
#include "cli/cpus.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace molmesh::cli {
namespace {

/// Microseconds, of all processors together, in a period; none: "max", negative, or no file.
bool read_quota(const std::filesystem::path& folder, int version, double& quota, double& period) {
  if (version == 2)
    return static_cast<bool>(std::ifstream(folder / "cpu.max") >> quota >> period);
  return std::ifstream(folder / "cpu.cfs_quota_us") >> quota &&
         std::ifstream(folder / "cpu.cfs_period_us") >> period;
}

} // namespace

int cpus_granted(const SystemFiles& system) {
  double least = 1e9;
  for_each_group(system, "cpu", [&](const std::filesystem::path& folder, int version) {
    double quota, period;
    if (read_quota(folder, version, quota, period) && quota > 0 && period > 0)
      least = std::min(least, quota / period);
  });
  return least < 1e6 ? static_cast<int>(std::ceil(least)) : -1;
}

int default_threads() {
  const int threads = par::default_threads(), granted = cpus_granted();
  return granted > 0 && !std::getenv("OMP_NUM_THREADS") ? std::min(threads, granted) : threads;
}

} // namespace molmesh::cli
