// fine_grid_test.cpp — on a grid far finer than the atoms, whose surface cells are merged, no point stays off.
#include "contour/contour.hpp"
#include "density/density.hpp"
#include "optimize/optimize.hpp"
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace molmesh;

TEST_CASE("merged surface cells of a fine grid: every surface point comes to lie on the isosurface") {
  std::mt19937 random(3);
  const auto step = [&] { return 3. * double(random()) / 4294967296. - 1.5; };
  Hierarchy h;
  Vec3d at{0.1, 0.2, 0.3};
  for (int k = 0; k < 30; ++k) { // a crumpled chain: creases and pockets
    h.atom.push_back({at, 1.7});
    at += Vec3d{step(), step(), step()};
  }
  density::Options fine;
  fine.spacing = 0.08;
  density::Counts counts;
  const BlockGrid grid = to_block_grid(density::compute(h, fine, counts), 1);
  contour::Options merged;
  merged.meshed = contour::Options::both;
  contour::Summary summary;
  TetMesh mesh = contour::contour(grid, merged, summary, [](const std::string&) {});
  const optimize::Result result = optimize::improve(mesh, &grid, {});
  REQUIRE(result.fidelity.points > 1000);
  const double edge = std::sqrt(4 / std::sqrt(3.) * result.fidelity.area / double(result.fidelity.triangles));
  CHECK(edge > 2 * fine.spacing);
  CHECK(result.fidelity.points_off == 0);
  CHECK(result.after.below_25 == 0);
  CHECK(result.after.above_140 == 0);
}
