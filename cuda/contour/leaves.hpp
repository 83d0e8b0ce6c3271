// leaves.hpp — surface cells, samples and leaves on a Backend: the host's own passes
// (libcommon/contour/octree/leaf_passes.hpp), so the same leaves.
#pragma once
#include "contour/octree/leaf_passes.hpp"
#include "contour/octree/leaves.hpp"
#include "cuda/contour/device_lattice.hpp"
#include <optional>

namespace molmesh::cuda {

/// What is selected stays in the Backend's memory.
template <par::Launcher Backend>
class DeviceLeaves {
public:
  explicit DeviceLeaves(Backend& b) : b_(b) {}

  void find_surface(const contour::Lattice& l) {
    leaves = {};
    surface = {};
    lattice.reset();
    lattice.emplace(b_, l);
    const BlockGrid& grid = l.grid();
    const auto corner = b_.upload(grid.corner.data(), static_cast<int64_t>(grid.corner.size()));
    const auto inside = b_.upload(grid.inside.data(), static_cast<int64_t>(grid.inside.size()));
    surface = contour::find_surface(
        b_, lattice->view, {corner.data(), corner.size(), inside.data(), inside.size()},
        [&](const contour::SurfaceCell* cells, int64_t n, double isovalue, contour::SurfaceSample* samples) {
          b_.for_n("make samples", n, contour::MakeSamples{cells, isovalue, samples});
        });
  }
  void select_leaves(const contour::Lattice& l, const contour::RefineOptions& options) {
    leaves = contour::LeafPasses<Backend>(b_, lattice->view, l.top_level,
                                          {surface.cells.data(), surface.samples.data(), surface.cells.n}, options)
                 .run();
  }
  /// Copies for the host.
  contour::Surface surface_on_host() { return {host(surface.cells), host(surface.samples)}; }
  contour::LeafList leaves_on_host() {
    return {host(leaves.key), host(leaves.level), host(leaves.block), host(leaves.large), leaves.adapt};
  }

  std::optional<DeviceLattice<Backend>> lattice;
  contour::SurfaceLists<Backend> surface;
  contour::LeafLists<Backend> leaves;

private:
  template <class T>
  LargeArray<T> host(const par::List<Backend, T>& list) {
    LargeArray<T> copy(static_cast<size_t>(list.n));
    b_.download(list.array, list.n, copy.data());
    return copy;
  }
  Backend& b_;
};

} // namespace molmesh::cuda
