// machine_test.cpp — how much memory and how many processors there are, as the system's files say it, and a process
// that asks for more memory.
#include "base/memory.hpp"
#include "child.hpp"
#include "cli/cpus.hpp"
#include <catch2/catch.hpp>
#include <new>
#include <sys/resource.h>
#include <vector>

using namespace molmesh;
using namespace molmesh::test;

namespace {

struct System {
  Folder folder;
  void says(const std::string& file, const std::string& text) const {
    const std::filesystem::path path = folder / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  int64_t at_hand(Swap swap = Swap::counts) const {
    return memory_at_hand({folder / "proc", folder / "groups"}, swap);
  }
  int cpus() const { return cli::cpus_granted({folder / "proc", folder / "groups"}); }
};

} // namespace

TEST_CASE("the least of what the system has and what control groups grant") {
  const System s;
  CHECK(s.at_hand() == -1);
  s.says("proc/meminfo", "MemTotal:  9000 kB\nMemAvailable:  8000 kB\nSwapTotal: 7 kB\nSwapFree:  3 kB\n");
  CHECK(s.at_hand() == 8003 * 1024);
  CHECK(s.at_hand(Swap::is_no_use) == 8000 * 1024);
  SECTION("version 2: a group, or one above it") {
    s.says("proc/self/cgroup", "0::/slurm/job_7/step_0\n");
    s.says("groups/slurm/job_7/step_0/memory.max", "max\n");
    CHECK(s.at_hand() == 8003 * 1024);
    s.says("groups/slurm/job_7/memory.max", "4096000\n");
    CHECK(s.at_hand() == 4096000);
    s.says("groups/slurm/job_7/step_0/memory.max", "2048000\n");
    CHECK(s.at_hand() == 2048000);
  }
  SECTION("version 1, and a container whose group is the topmost it sees") {
    s.says("proc/self/cgroup", "5:cpu,cpuacct:/\n4:hugetlb,memory:/box/a:b\n0::/\n");
    s.says("groups/memory/memory.limit_in_bytes", "9223372036854771712\n");
    s.says("groups/memory/box/a:b/memory.limit_in_bytes", "3000000\n");
    CHECK(s.at_hand() == 3000000);
    s.says("groups/memory/memory.limit_in_bytes", "1000000\n");
    CHECK(s.at_hand() == 1000000);
  }
}

TEST_CASE("the most memory that the process had in use is what the system says of it alone") {
  const System s;
  CHECK(peak_memory({s.folder / "proc", {}}) == -1);
  s.says("proc/self/status", "Name:\tx\nVmPeak:\t   900 kB\nVmHWM:\t   123 kB\nVmRSS:\t    77 kB\n");
  CHECK(peak_memory({s.folder / "proc", {}}) == 123 * 1024);
  const int64_t before = peak_memory();
  CHECK(before > 1'000'000);
  const std::vector<char> used(64 << 20, 'x');
  CHECK(peak_memory() >= 64 << 20);
  CHECK(used.back() == 'x');
}

TEST_CASE("the processors that control groups grant") {
  const System s;
  CHECK(s.cpus() == -1);
  SECTION("version 2: a group, or one above it") {
    s.says("proc/self/cgroup", "0::/slurm/job_7\n");
    s.says("groups/slurm/job_7/cpu.max", "max 100000\n");
    CHECK(s.cpus() == -1);
    s.says("groups/slurm/cpu.max", "400000 100000\n");
    CHECK(s.cpus() == 4);
    s.says("groups/slurm/job_7/cpu.max", "150000 100000\n");
    CHECK(s.cpus() == 2);
  }
  SECTION("version 1") {
    s.says("proc/self/cgroup", "5:cpu,cpuacct:/box\n4:memory:/\n0::/\n");
    s.says("groups/cpu/cpu.cfs_quota_us", "-1\n");
    s.says("groups/cpu/cpu.cfs_period_us", "100000\n");
    CHECK(s.cpus() == -1);
    s.says("groups/cpu/box/cpu.cfs_quota_us", "25000\n");
    CHECK(s.cpus() == -1); // no period
    s.says("groups/cpu/box/cpu.cfs_period_us", "50000\n");
    CHECK(s.cpus() == 1);
  }
}

TEST_CASE("the processors that a batch system's variable grants are a whole number above zero") {
  CHECK(cli::cpus_of_job("12") == 12);
  for (const char* text : {"", "0", "-3", "2x", " 2", "2(x3)", "99999999999999"})
    CHECK(cli::cpus_of_job(text) == -1);
  CHECK(cli::cpus_of_job(nullptr) == -1);
}

TEST_CASE("more memory than there is is refused before it is used") {
  const int64_t bytes = memory_at_hand();
  REQUIRE(bytes > 0);
  constexpr int refused = 0, granted = 1, no_limit = 2;
  const Outcome o = in_child([&] {
    limit_memory(2);
    rlimit limit{};
    getrlimit(RLIMIT_DATA, &limit);
    if (limit.rlim_cur == RLIM_INFINITY)
      return no_limit;
    try {
      ::operator delete(::operator new(static_cast<size_t>(2 * bytes)));
      return granted;
    } catch (const std::bad_alloc&) {
      ::operator delete(::operator new (size_t{1} << 24));
      lift_memory_limit();
      rlimit lifted{};
      getrlimit(RLIMIT_DATA, &lifted);
      return lifted.rlim_cur > limit.rlim_cur ? refused : granted;
    }
  });
  if (o.status == no_limit)
    WARN("skipped: a sanitizer has mapped more than there is");
  else
    CHECK(o.status == refused);
}

TEST_CASE("threads that the system does not start are counted and not tried again") {
  constexpr int no_limit = 77;
  const Outcome o = in_child([] {
    std::ifstream in("/proc/self/statm");
    rlim_t pages = 0;
    in >> pages;
    const rlim_t bytes = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{256} << 20);
    const rlimit addresses{bytes, bytes};
    if (setrlimit(RLIMIT_AS, &addresses) != 0)
      return no_limit;
    const int startable = cli::startable_threads(1024);
    return startable >= 1 && startable < 1024 ? 1 : 0;
  });
  if (o.status == no_limit)
    WARN("skipped: a sanitizer has mapped more than there is");
  else
    CHECK(o.status == 1);
  CHECK(o.err.empty());
  CHECK(in_child([] { return cli::startable_threads(3); }).status == 3);
}
