// surface_passes.hpp — from the block grid to the cells that the surface crosses, pass by pass, over a launcher.
#pragma once
#include "base/error.hpp"
#include "contour/surface/surface_items.hpp"
#include <algorithm>
#include <string>
#include <vector>

namespace molmesh::contour {

template <par::Launcher Launcher>
struct SurfaceLists {
  par::List<Launcher, SurfaceCell> cells;
  par::List<Launcher, SurfaceSample> samples;
};

/// BlockGrid's members of the same names.
struct GridBlocks {
  const Vec3i* corner;
  int64_t corners;
  const Vec3i* inside;
  int64_t insides;
};

/// make_samples(cells, n, isovalue, samples)
template <par::Launcher Launcher, class MakeSamples>
SurfaceLists<Launcher> find_surface(Launcher& m, const LatticeView& l, const GridBlocks& grid,
                                    MakeSamples make_samples) {
  const auto covered = par::gather<par::KeyedWord>(m, "cover blocks", grid.corners, CoveredBlocks{l, grid.corner});
  const auto covered_inside =
      par::gather<par::KeyedWord>(m, "cover blocks", l.any_cut ? grid.insides : 0, CoveredBlocks{l, grid.inside});
  const auto block = par::unite(m, {&covered, &covered_inside});
  auto crossed = m.template array<uint64_t>(8 * block.n), culprit = m.template array<uint64_t>(block.n);
  auto failed = m.template array<int64_t>(block.n + 1);
  m.for_n("find surface cells", block.n,
          CrossedCells{l, block.data(), crossed.data(), failed.data(), culprit.data()});
  if (m.scan("scan", failed.data(), block.n) > 0) {
    std::vector<int64_t> before(static_cast<size_t>(block.n) + 1);
    std::vector<uint64_t> key(static_cast<size_t>(block.n));
    m.download(failed, block.n + 1, before.data());
    m.download(culprit, block.n, key.data());
    const auto first = std::find(before.begin(), before.end(), 1) - before.begin() - 1;
    const Vec3i cell = morton_point(key[first]), p = l.base + cell;
    for (int a = 0; a < 3; ++a) // spacings beyond the grid
      if (cell[a] < l.grid_first[a] || cell[a] >= l.grid_last[a])
        refuse_surface_at_wall();
    fail_input("the density at index " + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
               std::to_string(p.z) +
               ": the surface crosses a cell with an inactive corner, expected every band cell in the grid");
  }
  SurfaceLists<Launcher> out;
  out.cells = par::gather<SurfaceCell>(m, "make surface cells", 8 * block.n,
                                       MakeSurfaceCells{l, block.data(), crossed.data()});
  out.samples = {m.template array<SurfaceSample>(out.cells.n), out.cells.n};
  make_samples(out.cells.data(), out.cells.n, double(l.isovalue), out.samples.data());
  return out;
}

struct SurfaceView {
  const SurfaceCell* cell;
  const SurfaceSample* sample;
  int64_t n;
};

} // namespace molmesh::contour
