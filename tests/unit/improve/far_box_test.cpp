// far_box_test.cpp — walls so far away that elements there are larger than tetsmooth's parts.
#include "contour/contour.hpp"
#include "density/density.hpp"
#include "improve/improve.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

TEST_CASE("in a far box elements larger than parts are improved too") {
  Hierarchy h;
  h.atom = {{{0.1, 0.2, 0.3}, 1.7}, {{1.3, 0.9, -0.4}, 1.5}, {{-0.6, 1.1, 1.2}, 1.8}};
  density::Options spacing;
  spacing.spacing = 0.5;
  density::Counts counts;
  const BlockGrid grid = density::to_block_grid(density::compute(h, spacing, counts), 1);
  const double scale = GENERATE(150., 400., 1000.);
  CAPTURE(scale);
  contour::Options options;
  options.meshed = contour::Options::exterior;
  options.box.kind = contour::BoxRequest::factor;
  options.box.scale = scale;
  contour::Summary summary;
  TetMesh mesh = contour::contour(grid, options, summary, [](const std::string&) {});
  const improve::Result result = improve::improve(mesh, &grid, {});
  CHECK(result.before.above_140 > 0);
  CHECK(result.after.above_140 == 0);
  CHECK(result.after.below_25 == 0);
}
