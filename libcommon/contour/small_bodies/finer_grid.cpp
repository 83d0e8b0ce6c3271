// finer_grid.cpp — halves the spacing while chords cut off more volume than I8 allows.
#include "contour/small_bodies/finer_grid.hpp"
#include "base/bits.hpp"
#include "contour/octree/chord_items.hpp"
#include "contour/octree/leaves.hpp"
#include "contour/small_bodies/halved_grid.hpp"
#include "contour/surface/ambiguous_cell.hpp"
#include "geom/morton.hpp"
#include "isosurface/isosurface_view.hpp"
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace molmesh::contour {
namespace {

constexpr int most_halvings = 2;
constexpr double room_to_halve = (1 << 18) - 8; ///< spacings of a box: a lattice takes twice as many
/// After halving, some 12 million elements: all of the grid is filled with the smaller cells.
constexpr double most_uniform_cells = 1 << 20;
/// With the default band some 16,000 surface cells; a ball of as many, 29 spacings in radius, loses 0.05 %.
constexpr int64_t few_active_points = 1 << 15;
/// Of more than these only grids of small bodies are looked at: a ball of 5 spacings has half a point inside for
/// each active one, a protein at 0.5 Å one and a half. Halved they are eight times as large at most.
constexpr int64_t most_active_points = 1 << 20;
constexpr double inside_of_small = 0.75;
/// A ball with as few surface cells loses several per cent, and their areas are not what cells have on average.
constexpr int64_t too_few_cells = 80;
/// Share of the volume, a fifth below I8's, and how many times as much as chords between samples those of
/// tetsmooth's larger triangles cut off: 1.14 to 1.39 on ions of 1.6 to 5 spacings.
constexpr double most_missing = 0.004, smoothed = 1.25;

int64_t active_points(const BlockGrid& grid) {
  int64_t n = 0;
  for (const uint64_t word : grid.active)
    n += count_bits(word);
  return n;
}

int64_t inside_points(const BlockGrid& grid) {
  const auto iso = static_cast<float>(grid.info.isovalue);
  return std::count_if(grid.value.begin(), grid.value.end(), [&](float v) { return v > iso; }) +
         512 * static_cast<int64_t>(grid.inside.size());
}

/// Twice its indices, and the box's that reach on from there, would be over 10^9, where IsosurfaceView knows none.
bool lies_too_far(const BlockGrid& grid) {
  constexpr int32_t far = (1 << 28) + (1 << 20);
  const Vec3i low = grid.frame.lower, high = low + grid.frame.points;
  return std::max({-low.x, -low.y, -low.z, high.x, high.y, high.z}) > far;
}

bool may_lose_too_much(const BlockGrid& grid) {
  const int64_t active = active_points(grid);
  return active <= few_active_points ||
         (active <= most_active_points && double(inside_points(grid)) < inside_of_small * double(active));
}

/// In the grid's spacings.
struct Bodies {
  int64_t cells = 0; ///< that the surface crosses
  SurfaceSums sums;  ///< area and volume
  double cut = 0;    ///< volume that chords between samples cut off

  Bodies(const Surface& surface, float isovalue) : cells(static_cast<int64_t>(surface.cells.size())) {
    std::vector<uint64_t> key;
    for (const SurfaceCell& cell : surface.cells)
      key.push_back(cell.key);
    const CutByCells chords{surface.cells.data(), surface.samples.data(), key.data(), cells, isovalue};
    for (size_t i = 0; i < key.size(); ++i) {
      sums += sums_of_cell(surface.cells[i], surface.samples[i], isovalue);
      cut += chords.of_cell(static_cast<int64_t>(i));
    }
  }
  /// given_back: tetsmooth puts points so far outside the isosurface.
  bool lose_too_much(double given_back) const {
    return cells > 0 && (cells < too_few_cells ||
                         smoothed * std::fabs(cut) > given_back * sums.area + most_missing * sums.volume());
  }
};

bool is_cut(const Surface& surface, const Lattice& lattice) {
  const auto on_wall = [&](Vec3i p) {
    return p.x == 0 || p.y == 0 || p.z == 0 || p.x == lattice.cells.x || p.y == lattice.cells.y ||
           p.z == lattice.cells.z;
  };
  return std::any_of(surface.cells.begin(), surface.cells.end(), [&](const SurfaceCell& cell) {
    for (int c = 0; c < 8; ++c)
      if (cell.value[c] > lattice.isovalue && on_wall(morton_point(cell.key) + corner_step(c)))
        return true;
    return false;
  });
}

/// Those in the grid, beyond which cells grow; of the inside alone as many as points, but all are looked at.
double uniform_cells(const BlockGrid& grid, const LatticeView& lattice, const Options& options) {
  constexpr double looked_at = 1. / 1024;
  double cells = 1;
  for (int a = 0; a < 3; ++a)
    cells *= std::min(lattice.cells[a], lattice.grid_last[a]) - std::max(0, lattice.grid_first[a]);
  return options.meshed == Options::interior ? std::max(double(inside_points(grid)), looked_at * cells) : cells;
}

/// halvings: of the spacing so far.
bool cells_too_large(const BlockGrid& grid, const Options& options, int halvings) {
  const Lattice lattice(grid, options.box, options.meshed != Options::interior, options.threads);
  const Vec3d extent = (lattice.position(lattice.cells) - lattice.position({0, 0, 0})) / grid.frame.spacing;
  if (std::max({extent.x, extent.y, extent.z}) >= room_to_halve)
    return false;
  if (options.adapt == 0 && 8 * uniform_cells(grid, lattice.view(), options) > most_uniform_cells)
    return false;
  const Surface surface = find_surface(lattice, options.threads);
  if (is_cut(surface, lattice))
    return false;
  const Bodies bodies(surface, lattice.isovalue);
  return bodies.lose_too_much(most_offset * (1 << halvings));
}

} // namespace

FinerGrid finer_grid(const BlockGrid& grid, const Options& options) {
  FinerGrid finer;
  if (!may_lose_too_much(grid))
    return finer;
  while (finer.halvings < most_halvings) {
    const BlockGrid& now = finer.grid ? *finer.grid : grid;
    if (lies_too_far(now) || !cells_too_large(now, options, finer.halvings))
      break;
    std::optional<BlockGrid> half = halved_alike(now, options.threads);
    if (!half)
      break;
    finer.grid = std::move(half);
    ++finer.halvings;
  }
  return finer;
}

} // namespace molmesh::contour
