// leaves.cpp — surface cells, their samples and the octree's leaves on the host's threads.
#include "contour/octree/leaves.hpp"
#include "contour/octree/leaf_passes.hpp"
#include "contour/surface/samples_simd.hpp"
#include "par/launcher.hpp"
#include <algorithm>

namespace molmesh::contour {
namespace {

/// As MakeSamples, eight cells at a time.
struct MakeEightSamples {
  const SurfaceCell* cell;
  int64_t cells;
  double isovalue;
  SurfaceSample* sample;
  void operator()(int64_t i) const {
    SurfaceCell eight[8];
    const int64_t first = 8 * i, n = std::min<int64_t>(8, cells - first);
    for (int64_t k = 0; k < 8; ++k)
      eight[k] = cell[first + std::min(k, n - 1)];
    EightSamples of;
    make_samples(eight, isovalue, of);
    for (int64_t k = 0; k < n; ++k)
      sample[first + k] = sample_of(eight[k], {of.point[0][k], of.point[1][k], of.point[2][k]},
                                    {of.gradient[0][k], of.gradient[1][k], of.gradient[2][k]});
  }
};

} // namespace

Surface find_surface(const Lattice& lattice, int threads) {
  par::HostLauncher launcher(threads);
  const BlockGrid& grid = lattice.grid();
  auto found =
      find_surface(launcher, lattice.view(),
                   {grid.corner.data(), static_cast<int64_t>(grid.corner.size()), grid.inside.data(),
                    static_cast<int64_t>(grid.inside.size())},
                   [&](const SurfaceCell* cells, int64_t n, double isovalue, SurfaceSample* samples) {
                     launcher.for_n("make samples", (n + 7) / 8, MakeEightSamples{cells, n, isovalue, samples});
                   });
  return {std::move(found.cells.array), std::move(found.samples.array)};
}

LeafList select_leaves(const Lattice& lattice, const Surface& surface, const RefineOptions& options, int threads) {
  par::HostLauncher launcher(threads);
  auto found =
      LeafPasses<par::HostLauncher>(
          launcher, lattice.view(), lattice.top_level,
          {surface.cells.data(), surface.samples.data(), static_cast<int64_t>(surface.cells.size())}, options)
          .run();
  return {std::move(found.key.array), std::move(found.level.array), std::move(found.block.array),
          std::move(found.large.array), found.adapt};
}

} // namespace molmesh::contour
