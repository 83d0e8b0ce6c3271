// phase_line_test.cpp — what a long run says of itself on a terminal.
#include "cli/phase_line.hpp"
#include <catch2/catch.hpp>
#include <fstream>
#include <string>

using namespace molmesh::cli;

TEST_CASE("a phase line has the phase and the seconds, and with a share the bar and the time left") {
  CHECK(phase_text("density2tet", "octree", -1, 3.4, 1) == "density2tet: octree, 3 s");
  CHECK(phase_text("tetsmooth", "improve", 0.5, 12, 10) ==
        "tetsmooth: improve [######......]  50 %, 12 s, about 10 s left");
  CHECK(phase_text("tetsmooth", "improve", 0, 1, 1) == "tetsmooth: improve [............]   0 %, 1 s");
  CHECK(phase_text("tetsmooth", "improve", 0.5, 16, 10, 4) ==
        "tetsmooth: improve [######......]  50 %, 16 s, about 6 s left");
  CHECK(phase_text("tetsmooth", "improve", 0.5, 32, 10, 20) ==
        "tetsmooth: improve [######......]  50 %, 32 s, about 0 s left");
}

TEST_CASE("a quiet phase line starts no thread that would have to end") {
  const auto threads = [] {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
      if (line.rfind("Threads:", 0) == 0)
        return line;
    return std::string();
  };
  const std::string before = threads();
  PhaseLine line("tetsmooth", true);
  line.phase("read");
  line.share(0.5);
  CHECK(threads() == before);
}

TEST_CASE("the share of the whole is foreseen from the phases before") {
  using molmesh::cli::foreseen_share;
  CHECK(foreseen_share(0, 0.1, 3, 3) == 0); // nothing is known yet
  CHECK(foreseen_share(0.2, 0.9, 2, 0) == Approx(0.2));
  CHECK(foreseen_share(0.2, 0.9, 2 + 3.5, 3.5) == Approx(0.55)); // 7 s foreseen after 2
  double before = 0;
  for (double t = 0; t < 30; t += 0.25) { // ever on, never there
    const double share = foreseen_share(0.2, 0.9, 2 + t, t);
    CHECK(share > before);
    CHECK(share < 0.9);
    before = share;
  }
}
