// leaves.cpp — the passes of detail/leaf_selection.hpp on the host's threads.
#include "contour/leaves.hpp"
#include "contour/detail/leaf_selection.hpp"
#include "par/launcher.hpp"

namespace molmesh::contour {

Surface find_surface(const Lattice& lattice, int threads) {
  par::Launcher launcher(threads);
  const BlockGrid& grid = lattice.grid();
  auto found = detail::find_surface(launcher, lattice.view(),
                                    {grid.corner.data(), static_cast<int64_t>(grid.corner.size()),
                                     grid.inside.data(), static_cast<int64_t>(grid.inside.size())});
  return {std::move(found.cells.array), std::move(found.samples.array)};
}

LeafList select_leaves(const Lattice& lattice, const Surface& surface, const RefineOptions& options, int threads) {
  par::Launcher launcher(threads);
  auto found =
      detail::LeafSelection<par::Launcher>(
          launcher, lattice.view(), lattice.top_level,
          {surface.cells.data(), surface.samples.data(), static_cast<int64_t>(surface.cells.size())}, options)
          .run();
  return {std::move(found.key.array), std::move(found.level.array), std::move(found.block.array),
          std::move(found.large.array)};
}

} // namespace molmesh::contour
