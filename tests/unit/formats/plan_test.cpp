// plan_test.cpp — plans of densities: motions in their order, and what is refused.
#include "formats/plan/plan.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace molmesh;
namespace fs = std::filesystem;

namespace {

std::vector<formats::PlanPiece> parse(const std::string& text, const std::string& file = "dir/x.join") {
  std::istringstream in(text);
  return formats::read_plan(in, file);
}

void check_near(Vec3d a, Vec3d b) {
  CHECK(norm(a - b) < 1e-12);
}

} // namespace

TEST_CASE("motions of a plan act one after the other, copies on copies") {
  const auto plan =
      parse("# two pieces\njoin 1\n\npiece a.vdb translate=1,0,0 rotate=0,0,1,90 lattice=2,1,2,10,0,100\n"
            "piece \"b c.vdb\" matrix=0,-1,0,5,1,0,0,6,0,0,1,7 combine=subtract\npiece /c.vdb helix=3,2,90\n");
  REQUIRE(plan.size() == 3);
  CHECK(plan[0].file == "dir/a.vdb");
  CHECK_FALSE(plan[0].subtract);
  REQUIRE(plan[0].copies.size() == 4);
  const Vec3d p{1, 2, 3}, first{-2, 2, 3};
  check_near(plan[0].copies[0](p), first);
  check_near(plan[0].copies[1](p), first + Vec3d{0, 0, 100});
  check_near(plan[0].copies[2](p), first + Vec3d{10, 0, 0});
  check_near(plan[0].copies[3](p), first + Vec3d{10, 0, 100});
  CHECK(plan[1].file == "dir/b c.vdb");
  CHECK(plan[1].subtract);
  check_near(plan[1].copies[0](p), {5 - 2, 6 + 1, 7 + 3});
  CHECK(plan[2].file == "/c.vdb");
  check_near(plan[2].copies[2](p), {-1, -2, 7});
  CHECK(plan[2].where == "dir/x.join:6");
}

TEST_CASE("every bad plan is refused by its rule") {
  const fs::path folder = fs::path(MOLMESH_SOURCE_DIR) / "formats/plan/samples/failed";
  int count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    INFO(entry.path());
    std::ifstream in(entry.path());
    const std::string rule = entry.path().filename().string().substr(0, 2);
    const std::string line = test::refusal(Status::bad_input, [&] { formats::read_plan(in, "x.join"); });
    CHECK(line.rfind("x.join:", 0) == 0);
    CHECK(line.find(": " + rule + ": ") != std::string::npos);
    ++count;
  }
  CHECK(count >= 10);
  for (const auto& entry : fs::directory_iterator(folder.parent_path() / "passed")) {
    INFO(entry.path());
    std::ifstream in(entry.path());
    CHECK(!formats::read_plan(in, "x.join").empty());
  }
}
