// finer_grid_test.cpp — half the spacing: the same values, sides and topology, and the volume of small bodies.
#include "contour/octree/chord_items.hpp"
#include "contour/octree/leaves.hpp"
#include "contour/small_bodies/finer_grid.hpp"
#include "contour/small_bodies/halved_grid.hpp"
#include "contour/stages.hpp"
#include "optimize/optimize.hpp"
#include "unit/contour/checked.hpp"
#include "unit/contour/sample_grid.hpp"
#include "unit/contour/trilinear_euler.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

using namespace molmesh;
using namespace molmesh::test;
using contour::Options;

namespace {

/// An atom off the grid points.
BlockGrid atom_grid(double radius, double h) {
  return cube_grid(radius + 6 * h, h, [=](Vec3d x) {
    return std::exp(radius * radius - norm2(x - h * Vec3d{0.23, 0.54, 0.79}));
  });
}

/// Both regions, uniform, in the cells of the grid itself.
TetMesh mesh_of_own_cells(const BlockGrid& grid) {
  const contour::Lattice lattice(grid, {}, true, 1);
  contour::HostStages stages(1);
  stages.find_surface(lattice);
  contour::RefineOptions uniform;
  uniform.adapt = 0;
  uniform.inside = uniform.outside = true;
  stages.select_leaves(uniform);
  Options both;
  both.meshed = Options::both;
  stages.make_dual(both.unmeshed_side(), [](const std::string&) {});
  stages.find_regions({});
  return stages.assemble(Options::both);
}

/// Checks one point between, or one of the grid's own.
void check_point(const BlockGrid& grid, const BlockIndex& index, const BlockGrid& half,
                 const BlockIndex& half_index, Vec3i q) {
  const Vec3i low{q.x >> 1, q.y >> 1, q.z >> 1};
  double sum = 0;
  int points = 0, active = 0, inside = 0;
  for (int c = 0; c < 8; ++c) {
    const Vec3i step{c & 1, c >> 1 & 1, c >> 2};
    if ((step.x && q.x % 2 == 0) || (step.y && q.y % 2 == 0) || (step.z && q.z % 2 == 0))
      continue;
    const float v = value_at(grid, index, low + step);
    sum += std::log(double(v));
    active += is_active(grid, index, low + step);
    inside += v > 1;
    ++points;
  }
  const float v = value_at(half, half_index, q);
  CHECK(is_active(half, half_index, q) == (active == points));
  if (points == 1)
    CHECK(v == value_at(grid, index, low));
  else if (active == points)
    CHECK(std::log(double(v)) == Approx(sum / points).margin(1e-6));
  if (inside == points)
    CHECK(v > 1);
  if (inside == 0)
    CHECK(!(v > 1));
}

} // namespace

TEST_CASE("half the spacing: the grid's values, means of log G between, each on its side") {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 12; ++trial) {
    CAPTURE(trial);
    const BlockGrid grid = random_grid(random, trial), half = contour::halved(grid, 1);
    CHECK(half.frame.spacing == grid.frame.spacing / 2);
    CHECK(half.frame.position(2 * grid.frame.lower) == grid.frame.position(grid.frame.lower));
    CHECK(std::is_sorted(half.corner.begin(), half.corner.end()));
    CHECK(std::is_sorted(half.inside.begin(), half.inside.end()));
    const BlockIndex index(grid), half_index(half);
    const Vec3i end = half.frame.lower + half.frame.points;
    Vec3i q;
    for (q.x = half.frame.lower.x; q.x < end.x; ++q.x)
      for (q.y = half.frame.lower.y; q.y < end.y; ++q.y)
        for (q.z = half.frame.lower.z; q.z < end.z; ++q.z)
          check_point(grid, index, half, half_index, q);
  }
}

TEST_CASE("half the spacing: blocks inside stay inside, and the same bytes at any number of threads") {
  const BlockGrid grid = atom_grid(12, 0.5), half = contour::halved(grid, 1), threads = contour::halved(grid, 3);
  REQUIRE(!grid.inside.empty());
  CHECK(half.inside.size() >= 8 * grid.inside.size());
  CHECK(value_at(half, BlockIndex(half), {0, 0, 0}) == 2);
  CHECK(half.corner == threads.corner);
  CHECK(half.value == threads.value);
  CHECK(half.active == threads.active);
  CHECK(half.inside == threads.inside);
}

TEST_CASE("finer grids keep components and Euler number", "[slow]") {
  std::mt19937_64 random(12);
  int finer_ones = 0;
  for (int trial = 1; trial < 60; ++trial) {
    CAPTURE(trial);
    const BlockGrid grid = random_grid(random, trial);
    Options options;
    options.adapt = 0.3;
    const contour::FinerGrid finer = contour::finer_grid(grid, options);
    if (!finer.grid)
      continue;
    ++finer_ones;
    Options uniform;
    uniform.adapt = 0;
    const Validity v = checked(mesh_of(grid, options)), of_grid = checked(mesh_of(grid, uniform));
    CHECK(v.surface.euler == of_grid.surface.euler);
    const Validity of_own_cells = checked(mesh_of_own_cells(grid));
    CHECK(v.surface.euler == of_own_cells.surface.euler);
    CHECK(v.surface.components == of_own_cells.surface.components);
    if (trial % 4 != 0) { // nothing at the isovalue, where rounding decides
      CHECK(trilinear_euler(*finer.grid) == trilinear_euler(grid));
      CHECK(v.surface.euler == trilinear_euler(grid));
    }
    CHECK(v.surface.components == of_grid.surface.components);
  }
  CHECK(finer_ones > 5);
}

TEST_CASE("a body of few spacings keeps its volume to half a per cent, in uniform cells too") {
  for (double radius : {0.8, 1.0, 1.15, 2.4, 3.5}) {
    const BlockGrid grid = atom_grid(radius, 0.5);
    for (auto [meshed, adapt] : {std::pair<decltype(Options::meshed), std::optional<double>>{Options::interior, {}},
                                 {Options::both, {}},
                                 {Options::interior, 0.}}) {
      CAPTURE(radius, int(meshed), adapt.has_value());
      Options options;
      options.meshed = meshed;
      options.adapt = adapt;
      contour::Summary summary;
      TetMesh mesh = mesh_of(grid, options, summary);
      CHECK(summary.halvings == (radius < 0.9 ? 2 : radius < 3.5 ? 1 : 0));
      CHECK(checked(mesh).surface.euler == 2);
      const optimize::Result result = optimize::improve(mesh, &grid, {});
      CHECK(checked(mesh).surface.euler == 2);
      CHECK(std::fabs(result.fidelity.missing) < 0.005 * result.fidelity.volume);
      CHECK(result.fidelity.points_off == 0);
      CHECK(result.after.min > 25);
      CHECK(result.after.max < 140);
    }
  }
}

TEST_CASE("a grid of many uniform cells is not filled with smaller ones") {
  Options options;
  options.adapt = 0;
  options.meshed = Options::both;
  BlockGrid grid = atom_grid(1, 0.5);
  for (const double factor : {6., 40.}) { // cells grow beyond the grid
    options.box.kind = contour::BoxRequest::factor;
    options.box.scale = factor;
    CHECK(contour::finer_grid(grid, options).grid);
  }
  grid.frame.lower -= Vec3i{25, 25, 25};
  grid.frame.points += Vec3i{50, 50, 50};
  CHECK(!contour::finer_grid(grid, options).grid);
  options.meshed = Options::interior; // few are inside
  CHECK(contour::finer_grid(grid, options).grid);
  options.meshed = Options::both;
  options.adapt.reset();
  CHECK(contour::finer_grid(grid, options).grid);
}

TEST_CASE(
    "the grid's own cells: of large bodies, where a wall cuts the surface, and on large grids of no small ones") {
  Options options;
  CHECK(!contour::finer_grid(atom_grid(5, 0.5), options).grid);
  const BlockGrid small = atom_grid(1, 0.5);
  const Vec3d middle{0.115, 0.27, 0.395};
  CHECK(contour::finer_grid(small, options).grid);
  options.box.kind = contour::BoxRequest::corners;
  options.box.lower = {0.1, -3, -3};
  options.box.upper = {3, 3, 3};
  CHECK(!contour::finer_grid(small, options).grid);
  const BlockGrid half = cube_grid(1, 0.5, [](Vec3d x) { return std::exp(0.5 - norm2(x + Vec3d{0, 0, 1})); });
  options.box.lower = {-1, -1, -1}; // on the grid's own plane
  options.box.upper = {1, 1, 1};
  CHECK(!contour::finer_grid(half, options).grid);
  for (const double wall : {2.1, 1.1}) { // not the surface, though it is in the last cells
    options.box.lower = middle - Vec3d{wall, wall, wall};
    options.box.upper = middle + Vec3d{wall, wall, wall};
    CHECK(contour::finer_grid(small, options).halvings == contour::finer_grid(small, {}).halvings);
  }
  const auto atoms = [](double radius) { // 7³
    return cube_grid(18, 0.5, [=](Vec3d x) {
      Vec3d from = x;
      for (int a = 0; a < 3; ++a)
        from[a] -= 4 * std::clamp(std::round(x[a] / 4), -3., 3.);
      return std::exp(radius * radius - norm2(from));
    });
  };
  CHECK(contour::finer_grid(atoms(1), {}).grid);
  CHECK(!contour::finer_grid(atoms(3.6), {}).grid); // one body
}

TEST_CASE(
    "the volume within the surface, from the lattice's lines: of balls, of two far apart, and of half a ball") {
  const auto ball = [](Vec3d x, double radius) { return std::exp((radius - norm(x)) / 4); };
  const auto volume_of = [](const BlockGrid& grid, const Options& options) {
    const contour::Lattice lattice(grid, options.box, false, 1);
    const contour::Surface surface = contour::find_surface(lattice, 1);
    contour::SurfaceSums sums;
    for (size_t i = 0; i < surface.cells.size(); ++i)
      sums += contour::sums_of_cell(surface.cells[i], surface.samples[i], lattice.isovalue);
    return std::pair{sums.volume(), sums.area};
  };
  const double pi = std::acos(-1.);
  const Vec3d off{0.23, 0.54, 0.79};
  for (double radius : {3., 6., 20.}) {
    CAPTURE(radius);
    const auto [volume, area] =
        volume_of(cube_grid(radius + 3, 1, [&](Vec3d x) { return ball(x - off, radius); }), {});
    CHECK(volume == Approx(4 * pi / 3 * radius * radius * radius).epsilon(radius < 4 ? 0.04 : 0.01));
    CHECK(area == Approx(4 * pi * radius * radius).epsilon(0.05));
  }
  const Vec3d apart{30, 31, 29};
  const auto two = [&](Vec3d x) { return std::max(ball(x - off - apart, 3), ball(x - off + apart, 3)); };
  CHECK(volume_of(cube_grid(36, 1, two), {}).first == Approx(2 * 36 * pi).epsilon(0.04));
  Options half;
  half.box.kind = contour::BoxRequest::corners;
  half.box.lower = {0, -12, -12};
  half.box.upper = {12, 12, 12};
  CHECK(volume_of(cube_grid(14, 1,
                            [&](Vec3d x) {
                              return ball(x - Vec3d{0, 0.54, 0.79}, 8);
                            }),
                  half)
            .first == Approx(2 * pi / 3 * 512).epsilon(0.1));
}

TEST_CASE("bodies far apart keep their volume") {
  const Vec3d apart{9.1, 8.3, 7.6};
  const BlockGrid grid = cube_grid(
      14, 0.5, [&](Vec3d x) { return std::exp(2.2 - norm2(x - apart)) + std::exp(2.2 - norm2(x + apart)); });
  contour::Summary summary;
  TetMesh mesh = mesh_of(grid, {}, summary);
  CHECK(summary.halvings == 1);
  const optimize::Result result = optimize::improve(mesh, &grid, {});
  CHECK(std::fabs(result.fidelity.missing) < 0.005 * result.fidelity.volume);
}

TEST_CASE("half the spacing with the topology of the grid", "[slow]") {
  std::mt19937_64 random(13);
  int other = 0, refused = 0;
  for (int trial = 0; trial < 100; ++trial) {
    CAPTURE(trial);
    const BlockGrid grid = random_grid(random, trial), half = contour::halved(grid, 1);
    const std::vector<Vec3i> others = contour::cells_of_other_topology(grid, half, 1);
    CHECK(others == contour::cells_of_other_topology(grid, half, 3));
    const std::optional<BlockGrid> alike = contour::halved_alike(grid, 2);
    refused += !alike;
    CHECK((alike || trial % 4 == 0)); // without ties there is always one
    if (!alike)
      continue;
    if (trial % 4 != 0) // nothing at the isovalue, where rounding decides
      CHECK(trilinear_euler(*alike) == trilinear_euler(grid));
    CHECK(alike->active == half.active);
    CHECK((alike->value == half.value) == others.empty()); // not printed
    other += !others.empty();
  }
  CHECK(other > 50);
  CHECK(refused < 30);
}

TEST_CASE("what chords of fine cells cut off a ball is the same share of h²/r² whatever its radius", "[slow]") {
  for (int radius : {6, 20, 110}) { // spacings; the largest by every other cell
    CAPTURE(radius);
    const BlockGrid grid = cube_grid(radius + 2, 1, [=](Vec3d x) {
      return std::exp((radius - norm(x - Vec3d{0.23, 0.54, 0.79})) / 4);
    });
    const contour::Lattice lattice(grid, {}, false, 2);
    const contour::Surface surface = contour::find_surface(lattice, 2);
    const auto n = static_cast<int64_t>(surface.cells.size());
    std::vector<uint64_t> key;
    for (const contour::SurfaceCell& cell : surface.cells)
      key.push_back(cell.key);
    contour::CutByCells item{surface.cells.data(), surface.samples.data(), key.data(), n, lattice.isovalue};
    std::vector<double> cut(static_cast<size_t>(item.items(n)));
    item.cut = cut.data();
    for (int64_t i = 0; i < item.items(n); ++i)
      item(i);
    const double share = std::accumulate(cut.begin(), cut.end(), 0.) / (4 * std::acos(-1.) / 3 * radius);
    CHECK(share == Approx(0.355).epsilon(0.05));
    CHECK((radius == 110) == (n > contour::CutByCells::enough));
  }
}
