// foreign_test.cpp — a mesh that we did not make is improved too, its surface kept.
#include "contour/contour.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/validity.hpp"
#include "optimize/optimize.hpp"
#include "oracles.hpp"
#include "structure.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

TEST_CASE("TetGen's mesh of 1TII reaches 15 degrees, with its surface kept") {
  const BlockGrid grid = reference::density_of(MOLMESH_SOURCE_DIR "/tests/data/1tii.pdb", 2);
  contour::Options options;
  options.fill_cavities = true;
  options.drop_below = 50;
  contour::Summary summary;
  const TetMesh ours = contour::contour(grid, options, summary, [](const std::string&) {});
  TetMesh mesh = reference::tetgen_fill(ours.point, ours.tri, {}, "q1.6");
  const LargeArray<int32_t> across = face_neighbors(mesh, 1);
  for (size_t f = 0; f < across.size(); ++f)
    if (across[f] < 0) {
      mesh.tri.push_back(face_points(mesh, static_cast<int64_t>(f)));
      mesh.boundary.push_back(surface);
    }
  const Validity before = check_validity(mesh, 1);
  optimize::Options how;
  how.threads = 2;
  const optimize::Result result = optimize::improve(mesh, nullptr, how);
  INFO("before " << result.before.min << " to " << result.before.max << ", after " << result.after.max);
  CHECK(result.before.min < 10);
  CHECK(result.after.min >= 15);
  const Validity after = check_validity(mesh, 1);
  CHECK(after.valid());
  REQUIRE(after.region.size() == 1);
  CHECK(after.region[0].boundary.euler == before.region[0].boundary.euler);
  CHECK(after.region[0].boundary.components == before.region[0].boundary.components);
  CHECK(after.region[0].volume == Approx(before.region[0].volume).epsilon(0.005));
}
