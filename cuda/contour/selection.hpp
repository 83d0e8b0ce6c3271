// selection.hpp — surface cells, samples and leaves on a Backend: the host's own passes
// (libcommon/contour/detail/leaf_selection.hpp), so the same leaves.
#pragma once
#include "contour/detail/leaf_selection.hpp"
#include "contour/leaves.hpp"
#include "cuda/contour/device_lattice.hpp"
#include <optional>

namespace molmesh::cuda {

/// What is selected stays in the Backend's memory; each step also answers with a copy for the host.
template <class Backend>
class Selection {
public:
  explicit Selection(Backend& b) : b_(b) {}

  contour::Surface find_surface(const contour::Lattice& l) {
    leaves = {};
    surface = {};
    lattice.reset();
    lattice.emplace(b_, l);
    const BlockGrid& grid = l.grid();
    const auto corner = b_.upload(grid.corner.data(), static_cast<int64_t>(grid.corner.size()));
    const auto inside = b_.upload(grid.inside.data(), static_cast<int64_t>(grid.inside.size()));
    surface = contour::detail::find_surface(b_, lattice->view,
                                            {corner.data(), corner.size(), inside.data(), inside.size()});
    return {host(surface.cells), host(surface.samples)};
  }
  contour::LeafList select_leaves(const contour::Lattice& l, const contour::RefineOptions& options) {
    leaves = contour::detail::LeafSelection<Backend>(
                 b_, lattice->view, l.top_level, {surface.cells.data(), surface.samples.data(), surface.cells.n},
                 options)
                 .run();
    return {host(leaves.key), host(leaves.level), host(leaves.block), host(leaves.large)};
  }

  std::optional<DeviceLattice<Backend>> lattice;
  contour::detail::SurfaceLists<Backend> surface;
  contour::detail::LeafLists<Backend> leaves;

private:
  template <class T>
  LargeArray<T> host(const contour::detail::List<Backend, T>& list) {
    LargeArray<T> copy(static_cast<size_t>(list.n));
    b_.download(list.array, list.n, copy.data());
    return copy;
  }
  Backend& b_;
};

} // namespace molmesh::cuda
