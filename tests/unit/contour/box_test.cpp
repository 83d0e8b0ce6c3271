// box_test.cpp — outer boxes: exact walls, cuts through the molecule, what is refused.
#include "base/error.hpp"
#include "contour/contour.hpp"
#include "contour/octree/lattice.hpp"
#include "optimize/optimize.hpp"
#include "unit/contour/checked.hpp"
#include "unit/contour/sample_grid.hpp"
#include "unit/refusal.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;
using namespace molmesh::test;
using contour::Options;

TEST_CASE("boxes: exact walls, a cut through the molecule, few elements far away") {
  const BlockGrid grid = cube_grid(6, 0.5, atom);
  Options options;
  options.meshed = Options::both;
  options.box.kind = contour::BoxRequest::corners;
  options.box.lower = {-7.3, -11.1, -6.2};
  options.box.upper = {8.125, 9.77, 14.01};
  Validity v = checked(mesh_of(grid, options));
  CHECK(v.low == options.box.lower);
  CHECK(v.high == options.box.upper);

  SECTION("a cut") {
    options.box.lower = {-1.1, -9, -9};
    options.box.upper = {9, 0.77, 9};
    for (auto meshed : {Options::interior, Options::exterior, Options::both}) {
      options.meshed = meshed;
      v = checked(mesh_of(grid, options));
    }
    CHECK(v.low == options.box.lower);
    CHECK(v.high == options.box.upper);
    CHECK(region_volume(v, molecule) > 20);
  }
  SECTION("a box that misses the grid") {
    options.box.lower = {100, -9, -9};
    options.box.upper = {120, 9, 9};
    CHECK_THROWS_WITH(mesh_of(grid, options), Catch::Contains("expected a box that meets the grid"));
    options.box.lower = {-9, -9, -120};
    options.box.upper = {9, 9, -100};
    CHECK_THROWS_AS(mesh_of(grid, options), Error);
    options.box.lower = {-1, -1, -1}; // within the molecule
    options.box.upper = {1.5, 1, 1.2};
    contour::Summary summary;
    CHECK(region_volume(checked(mesh_of(grid, options, summary)), molecule) == Approx(2.5 * 2 * 2.2));
    CHECK(summary.halvings == 0); // there is no body to be small
    options.meshed = Options::exterior;
    CHECK_THROWS_WITH(mesh_of(grid, options), Catch::Contains("nothing to mesh"));
  }
  SECTION("a near box, within the grid") {
    options.box.kind = contour::BoxRequest::factor;
    options.box.scale = 1.1;
    TetMesh near = mesh_of(grid, options);
    v = checked(near);
    CHECK(v.high.x - v.low.x == Approx(1.1 * 6));
    options.box.scale = 3;
    TetMesh far = mesh_of(grid, options);
    for (TetMesh* mesh : {&near, &far}) { // before that chords may cut off what it gives back
      const optimize::Fidelity surface = optimize::improve(*mesh, &grid, {}).fidelity;
      CHECK(std::fabs(surface.missing) < 0.005 * surface.volume);
    }
    CHECK(region_volume(checked(near), molecule) == Approx(region_volume(checked(far), molecule)).epsilon(0.002));
  }
  SECTION("a far box") {
    options.box.kind = contour::BoxRequest::factor;
    options.box.scale = 3;
    const size_t near = mesh_of(grid, options).tet.size();
    options.box.scale = 40;
    const TetMesh far = mesh_of(grid, options);
    v = checked(far);
    CHECK(v.high.x - v.low.x == Approx(40 * 6));
    // A shell for each doubling of the box, whatever the molecule's size: of some 130 cells.
    CHECK(double(far.tet.size()) - double(near) < 2000 * std::log2(40. / 3));
    options.box.scale = 1000;
    CHECK(double(mesh_of(grid, options).tet.size()) - double(far.tet.size()) < 2000 * std::log2(1000. / 40));
    options.box.scale = 20; // 130 spacings: no multiple of a large cell's edge
    CHECK(mesh_of(grid, options).tet.size() < 1.05 * double(far.tet.size()));
  }
}

namespace {

/// The same points by other indices.
BlockGrid renumbered(BlockGrid grid, Vec3i by) {
  grid.frame.lower += by;
  grid.frame.origin = grid.frame.origin - grid.frame.spacing * Vec3d{double(by.x), double(by.y), double(by.z)};
  for (auto* corners : {&grid.corner, &grid.inside})
    for (Vec3i& corner : *corners)
      corner += by;
  return grid;
}

} // namespace

TEST_CASE("near the end of all indices a small body is meshed in the grid's own cells") {
  const BlockGrid grid = cube_grid(6, 0.5, atom);
  Options options;
  options.meshed = Options::both;
  for (const bool far : {false, true}) {
    const int32_t shift = far ? (1 << 29) - 64 : 0;
    contour::Summary summary;
    CHECK(checked(mesh_of(renumbered(grid, {shift, -shift, shift}), options, summary)).surface.euler == 2);
    CHECK((summary.halvings == 0) == far);
  }
}

TEST_CASE("a mesh does not depend on where the grid's indices begin") {
  const BlockGrid grid = cube_grid(6, 0.5, atom);
  for (const int32_t shift : {-(1 << 21), 1 << 21, 1 << 28}) {
    const BlockGrid moved = renumbered(grid, {shift, -shift, shift});
    for (const auto kind :
         {contour::BoxRequest::automatic, contour::BoxRequest::factor, contour::BoxRequest::corners}) {
      Options options;
      options.box.kind = kind;
      options.box.scale = 2;
      options.box.lower = {-7, -7, -1};
      options.box.upper = {8, 7, 7};
      CAPTURE(shift, int(kind));
      const bool same = mesh_of(moved, options).tet == mesh_of(grid, options).tet;
      CHECK(same);
    }
  }
}

TEST_CASE("a wall on a grid plane takes its place, whatever rounding makes of it") {
  BlockGrid grid = cube_grid(6, 0.3, atom);
  contour::BoxRequest box;
  box.kind = contour::BoxRequest::corners;
  int64_t astray = 0; // by rounding
  for (int i = 0; i < 40; ++i) {
    grid.frame.origin = {1.0 / 3 + 12.345 * i, -7.1 * i, 1e3 + 0.7 * i};
    box.lower = grid.frame.position({-14, -13, -10});
    box.upper = grid.frame.position({14, 15, 18});
    for (int a = 0; a < 3; ++a)
      astray += (box.upper[a] - grid.frame.origin[a]) / 0.3 < Vec3i{14, 15, 18}[a];
    const contour::Lattice lattice(grid, box, true, 1);
    CHECK(lattice.cells.x == 28);
    CHECK(lattice.cells.y == 28);
    CHECK(lattice.cells.z == 28);
    const contour::LatticeView& view = lattice.view();
    for (int a = 0; a < 3; ++a)
      for (size_t side = 0; side < 2; ++side) { // as the plane that it is, within the grid's 20 on each side
        CHECK(view.cut[a][side].cuts);
        CHECK(view.cut[a][side].share == 0);
      }
    CHECK(lattice.position({0, 0, 0}) == box.lower);
    CHECK(lattice.position(lattice.cells) == box.upper);
  }
  CHECK(astray > 10);
}

TEST_CASE("a surface that meets the wall is refused unless the box was asked to cut it") {
  Options options;
  // The second one's lattice is wider than the grid, for the largest cells to fill it.
  const BlockGrid corners_outside = cube_grid(2.5, 0.5, atom),
                  half = test::sample_grid({-12, -12, 0}, {25, 25, 13}, 0.5, 2, atom);
  for (const BlockGrid* grid : {&corners_outside, &half}) {
    CHECK_THROWS_WITH(mesh_of(*grid, options), Catch::Contains("the surface meets the wall of the box"));
    CHECK(refusal(Status::failed, [&] { mesh_of(*grid, options); }).find("[margin]") != std::string::npos);
  }
}

TEST_CASE("a far wall takes no digits from the volumes of parts") {
  const BlockGrid grid = cube_grid(6, 1, [](Vec3d x) { return std::exp(2 - norm(x - Vec3d{0.2, 0.3, 0.1})); });
  Options options;
  options.adapt = 0;
  options.box.kind = contour::BoxRequest::factor;
  options.meshed = Options::both;
  for (const double scale : {2., 2000., 20'000.}) {
    CAPTURE(scale);
    options.box.scale = scale;
    contour::Summary summary;
    const Validity v = checked(mesh_of(grid, options, summary));
    REQUIRE(summary.molecule_volumes.size() == 1);
    CHECK(summary.molecule_volumes[0] == Approx(region_volume(v, 1)).epsilon(1e-11));
  }
}

TEST_CASE("without a least volume no part is dropped, whatever rounding makes of its volume") {
  std::vector<contour::Component> part(2);
  part[0].at_wall = true;
  part[1].inside = true;
  const std::vector<contour::ComponentSurface> surfaces{{1, 0, -1e-9}};
  contour::assign_regions(part, surfaces, {});
  CHECK(part[1].region == molecule);
  contour::RegionOptions drop;
  drop.drop_below = 1e-3;
  part[1].volume = 0;
  contour::assign_regions(part, surfaces, drop);
  CHECK(part[1].region == outside);
}
