// cpus.cpp — the cpu controllers of control groups, versions 1 and 2, and what Slurm says.
#include "cli/cpus.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <sys/mman.h>
#include <sys/resource.h>
#include <system_error>
#include <thread>
#include <vector>

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

int cpus_of_job(const char* text) {
  if (!text)
    return -1;
  int cpus = 0;
  const char* const end = text + std::strlen(text);
  const auto [stopped, error] = std::from_chars(text, end, cpus);
  return error == std::errc() && stopped == end && cpus > 0 ? cpus : -1;
}

int default_threads() {
  int threads = par::default_threads();
  if (std::getenv("OMP_NUM_THREADS"))
    return threads;
  for (const int limit : {cpus_granted(), cpus_of_job(std::getenv("SLURM_CPUS_PER_TASK"))})
    threads = limit > 0 ? std::min(threads, limit) : threads;
  return threads;
}

int startable_threads(int wanted) {
  constexpr size_t room = size_t{32} << 20; // bytes that must be left beside the stacks
  std::atomic<bool> all_started{false};
  std::vector<std::thread> started;
  void* const left = mmap(nullptr, room, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  bool good = left != MAP_FAILED;
  try {
    while (good && static_cast<int>(started.size()) + 1 < wanted)
      started.emplace_back([&] { all_started.wait(false); });
  } catch (const std::system_error&) {
    good = false;
  } catch (const std::bad_alloc&) {
    good = false;
  }
  all_started = true;
  all_started.notify_all();
  for (std::thread& t : started)
    t.join();
  if (left != MAP_FAILED)
    munmap(left, room);
  if (!good)
    return static_cast<int>(started.size()) + 1;
  rlimit addresses{};
  if (getrlimit(RLIMIT_AS, &addresses) == 0 && addresses.rlim_cur != RLIM_INFINITY)
    par::start_threads_during(wanted, [] {});
  return wanted;
}

} // namespace molmesh::cli
