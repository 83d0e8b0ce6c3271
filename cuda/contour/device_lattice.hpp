// device_lattice.hpp — the lattice and the block grid under it in a Backend's memory.
#pragma once
#include "contour/octree/lattice.hpp"
#include "cuda/par/backend.hpp"

namespace molmesh::cuda {

template <par::Launcher Backend>
class DeviceLattice {
  template <class T>
  using Array = typename Backend::template Array<T>;

public:
  DeviceLattice(Backend& b, const contour::Lattice& lattice) : view(lattice.view()) {
    const BlockGrid& grid = lattice.grid();
    const auto up = [&](auto& store, const auto* from, size_t n) {
      store = b.upload(from, static_cast<int64_t>(n));
      return store.data();
    };
    const auto capacity = static_cast<size_t>(lattice.index().capacity());
    view.index.key = up(key_, view.index.key, capacity);
    view.index.block = up(block_, view.index.block, capacity);
    for (int a = 0; a < 3; ++a)
      view.axis[a] = up(axis_[a], view.axis[a], static_cast<size_t>(view.cells[a]) + 1);
    view.grid = up(grid_, grid.value.data(), grid.value.size());
    view.active_words = up(active_, grid.active.data(), grid.active.size());
    inside_ = b.template array<uint64_t>(active_.size());
    b.for_n("inside words", inside_.size(), contour::SetInsideWords{view.grid, view.isovalue, inside_.data()},
            {double(inside_.size()) * 264});
    view.inside_words = inside_.data();
  }
  contour::LatticeView view;

private:
  Array<Vec3i> key_;
  Array<int64_t> block_;
  Array<double> axis_[3];
  Array<float> grid_;
  Array<uint64_t> active_, inside_;
};

} // namespace molmesh::cuda
