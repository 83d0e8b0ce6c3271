// memory.cpp — reads /proc/meminfo and the memory controllers of control groups, versions 1 and 2.
#include "base/memory.hpp"
#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

namespace molmesh {
namespace {

constexpr int64_t unknown = std::numeric_limits<int64_t>::max();

/// MemAvailable and, where it counts, SwapFree, in bytes.
int64_t of_system(const std::filesystem::path& proc, Swap swap) {
  std::ifstream in(proc / "meminfo");
  int64_t sum = 0;
  bool found = false;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string name;
    int64_t kilobytes = 0;
    if (words >> name >> kilobytes && (name == "MemAvailable:" || (swap == Swap::counts && name == "SwapFree:"))) {
      found = found || name == "MemAvailable:";
      sum += 1024 * kilobytes;
    }
  }
  return found ? sum : unknown;
}

/// What a file of one number says; "max" and no file: no limit.
int64_t limit_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  int64_t bytes = 0;
  return in >> bytes ? bytes : unknown;
}

} // namespace

int64_t memory_at_hand(const SystemFiles& system, Swap swap) {
  int64_t least = of_system(system.proc, swap);
  for_each_group(system, "memory", [&](const std::filesystem::path& folder, int version) {
    least = std::min(least, limit_in(folder / (version == 2 ? "memory.max" : "memory.limit_in_bytes")));
  });
  return least == unknown ? -1 : least;
}

int64_t peak_memory(const SystemFiles& system) {
  std::ifstream in(system.proc / "self" / "status");
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string name;
    int64_t kilobytes = 0;
    if (words >> name >> kilobytes && name == "VmHWM:")
      return 1024 * kilobytes;
  }
  return -1;
}

namespace {
std::optional<rlimit> before_limit;
}

void limit_memory(int threads) {
  int64_t bytes = memory_at_hand();
  if (bytes < 0)
    return;
  rlimit stack{}, limit{};
  if (getrlimit(RLIMIT_STACK, &stack) == 0)
    bytes += threads * static_cast<int64_t>(std::min(stack.rlim_cur, rlim_t{1} << 30));
  std::ifstream in("/proc/self/statm");
  int64_t total = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0; // in pages
  if (!(in >> total >> resident >> shared >> text >> library >> data) || data * sysconf(_SC_PAGESIZE) >= bytes ||
      getrlimit(RLIMIT_DATA, &limit) != 0)
    return;
  before_limit = limit;
  limit.rlim_cur = std::min(limit.rlim_cur, static_cast<rlim_t>(bytes));
  setrlimit(RLIMIT_DATA, &limit);
}

void lift_memory_limit() {
  if (before_limit)
    setrlimit(RLIMIT_DATA, &*before_limit);
}

} // namespace molmesh
