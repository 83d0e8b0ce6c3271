// phase_line_test.cpp — what a long run says of itself on a terminal.
#include "cli/phase_line.hpp"
#include <catch2/catch.hpp>

using namespace molmesh::cli;

TEST_CASE("a phase line has the phase and the seconds, and with a share the bar and the time left") {
  CHECK(phase_text("density2tet", "octree", -1, 3.4, 1) == "density2tet: octree, 3 s");
  CHECK(phase_text("tetsmooth", "improve", 0.5, 12, 10) ==
        "tetsmooth: improve [######......]  50 %, 12 s, about 10 s left");
  CHECK(phase_text("tetsmooth", "improve", 0, 1, 1) == "tetsmooth: improve [............]   0 %, 1 s");
}

TEST_CASE("a phase line without a terminal writes nothing and ends") {
  PhaseLine line("tetsmooth", false);
  line.phase("read");
  line.share(0.5);
}
