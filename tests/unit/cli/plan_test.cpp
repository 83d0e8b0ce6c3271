// plan_test.cpp — sizes as people write them, and what a batch system grants.
#include "base/error.hpp"
#include "child.hpp"
#include "cli/plan.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

TEST_CASE("a size of memory is a number with K, M, G or T, in powers of 1024") {
  CHECK(cli::bytes_of("1000000") == 1000000);
  CHECK(cli::bytes_of("500M") == int64_t{500} << 20);
  CHECK(cli::bytes_of("1.5G") == int64_t{3} << 29);
  CHECK(cli::bytes_of("2T") == int64_t{2} << 40);
  for (const char* text : {"", "G", "0", "-1G", "2GB", "2g", "1e3", "inf", "9999999T", "2 G"})
    CHECK_THROWS_AS(cli::bytes_of(text), Error);
}

TEST_CASE("speeds are one for all stages, or one for each") {
  const cli::Speeds one = cli::speeds_of("0.5", "--speed"), each = cli::speeds_of("1.2,0.9,2", "--speed");
  CHECK(one.hier2density == 0.5);
  CHECK(one.density2tet == 0.5);
  CHECK(one.tetsmooth == 0.5);
  CHECK(each.hier2density == 1.2);
  CHECK(each.density2tet == 0.9);
  CHECK(each.tetsmooth == 2);
  for (const char* text :
       {"", "x", "0", "-1", "inf", "nan", "1,", ",1", "1,2", "1,2,3,4", "1,2,0", "1;2;3", "1,2,3 "})
    CHECK_THROWS_AS(cli::speeds_of(text, "--speed"), Error);
}

TEST_CASE("sizes are shown with three digits, in powers of ten") {
  CHECK(cli::size_text(999) == "999 B");
  CHECK(cli::size_text(531'400'000) == "531 MB");
  CHECK(cli::size_text(2'147'483'648) == "2.15 GB");
  CHECK(cli::size_text(999'600) == "1 MB");
}

TEST_CASE("the memory that is granted is the least of the control groups' and Slurm's") {
  const Folder folder;
  const SystemFiles system{folder / "proc", folder / "groups"};
  const auto says = [&](const std::string& file, const std::string& text) {
    const std::filesystem::path path = folder / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  };
  CHECK(cli::granted_memory(nullptr, system) == -1);
  CHECK(cli::granted_memory("2000", system) == int64_t{2000} << 20);
  CHECK(cli::granted_memory("0", system) == -1);
  CHECK(cli::granted_memory("2G", system) == -1);
  says("proc/self/cgroup", "0::/job\n");
  says("groups/job/memory.max", "max\n");
  CHECK(cli::granted_memory(nullptr, system) == -1);
  says("groups/job/memory.max", "1000000000\n");
  CHECK(cli::granted_memory("2000", system) == 1000000000);
  CHECK(cli::granted_memory("500", system) == int64_t{500} << 20);
  CHECK(cli::machine_memory(system) == -1);
  says("proc/meminfo",
       "MemTotal:       16000 kB\nMemFree:         1000 kB\nSwapTotal:       3000 kB\nHugePages_Total:       0\n");
  CHECK(cli::machine_memory(system) == 19000 * 1024);
}
