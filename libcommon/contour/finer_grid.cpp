// finer_grid.cpp — what chords between neighbouring cells' samples cut off, against what I8 allows.
#include "contour/finer_grid.hpp"
#include "contour/detail/chord_items.hpp"
#include "contour/halved_grid.hpp"
#include "contour/leaves.hpp"
#include "geom/bits.hpp"
#include "improve/isosurface_view.hpp"
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace molmesh::contour {
namespace {

constexpr int most_halvings = 2;
constexpr double room_to_halve = (1 << 18) - 8; ///< spacings of a box: a lattice takes twice as many
/// Of a uniform lattice, some 12 million elements: it is filled with the smaller cells.
constexpr double most_uniform_cells = 1 << 20;
/// With the default band some 16,000 surface cells; a ball of as many, 29 spacings in radius, loses 0.05 %.
constexpr int64_t most_active_points = 1 << 15;
/// A ball with as few surface cells loses several per cent, and their areas are not what cells have on average.
constexpr int64_t too_few_cells = 80;
/// Share of the volume, a fifth below I8's, and how many times as much as chords between samples those of
/// tetsmooth's larger triangles cut off: 1.14 to 1.33 on ions of 1.6 to 5 spacings.
constexpr double most_missing = 0.004, smoothed = 1.25;

int64_t active_points(const BlockGrid& grid) {
  int64_t n = 0;
  for (const uint64_t word : grid.active)
    n += count_bits(word);
  return n;
}

/// The surface is one disc in each of its cells, whatever is interpolated.
bool one_sheet_a_cell(const Surface& surface, float isovalue) {
  const detail::OneDisc one_disc;
  return std::all_of(surface.cells.begin(), surface.cells.end(),
                     [&](const SurfaceCell& cell) { return one_disc(detail::inside_corners(cell, isovalue)); });
}

/// Volumes in cubed spacings. given_back: tetsmooth puts points so far outside the isosurface, spacings.
bool chords_cut_too_much(const Surface& surface, float isovalue, double given_back) {
  const auto n = static_cast<int64_t>(surface.cells.size());
  std::vector<uint64_t> key;
  for (const SurfaceCell& cell : surface.cells)
    key.push_back(cell.key);
  detail::SurfaceSums all;
  double cut = 0;
  for (int64_t i = 0; i < n; ++i) {
    all += detail::of_sample(surface.samples[static_cast<size_t>(i)]);
    cut += detail::CutByCells{surface.cells.data(), surface.samples.data(), key.data(), n, isovalue}.of_cell(i);
  }
  return n < too_few_cells || smoothed * std::fabs(cut) > given_back * all.area + most_missing * all.volume();
}

struct Look {
  bool one_sheet_a_cell = false, cells_too_large = false;
};
/// halvings: of the spacing so far.
Look look_at(const BlockGrid& grid, const Options& options, int halvings) {
  const Lattice lattice(grid, options.box, options.meshed != Options::interior, options.threads);
  const Vec3d extent = (lattice.position(lattice.cells) - lattice.position({0, 0, 0})) / grid.frame.spacing;
  if (lattice.view().any_cut || std::max({extent.x, extent.y, extent.z}) >= room_to_halve)
    return {};
  if (options.adapt == 0 &&
      double(lattice.cells.x) * double(lattice.cells.y) * double(lattice.cells.z) > most_uniform_cells)
    return {};
  const Surface surface = find_surface(lattice, options.threads);
  return {one_sheet_a_cell(surface, lattice.isovalue),
          chords_cut_too_much(surface, lattice.isovalue, improve::most_offset * (1 << halvings))};
}

} // namespace

FinerGrid finer_grid(const BlockGrid& grid, const Options& options) {
  FinerGrid finer;
  if (active_points(grid) > most_active_points)
    return finer;
  Look look = look_at(grid, options, 0);
  while (look.one_sheet_a_cell && look.cells_too_large && finer.halvings < most_halvings) {
    BlockGrid half = halved(finer.grid ? *finer.grid : grid, options.threads);
    look = look_at(half, options, finer.halvings + 1);
    if (!look.one_sheet_a_cell)
      break;
    finer.grid = std::move(half);
    ++finer.halvings;
  }
  return finer;
}

} // namespace molmesh::contour
