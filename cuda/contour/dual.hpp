// dual.hpp — contour::make_dual on a Backend, by the host's own passes and functions: the same complex and
// elements.
#pragma once
#include "contour/detail/octree_index.hpp"
#include "contour/dual.hpp"
#include "cuda/contour/elements.hpp"
#include "cuda/contour/selection.hpp"
#include "cuda/par/backend.hpp"
#include <utility>

namespace molmesh::cuda {

/// Of the selection's lattice, surface and leaves, which have stayed in the Backend's memory.
template <class Backend>
class DualMaker {
  template <class T>
  using Array = typename Backend::template Array<T>;

public:
  DualMaker(Backend& b, const Selection<Backend>& selected) : b_(b), selected_(selected) {}

  contour::Dual operator()(const contour::DualInput& in, const std::function<void(const std::string&)>& on_phase) {
    on_host_ = false;
    if (bytes(in) <= b_.room()) {
      try {
        return on_device(in, on_phase);
      } catch (const OutOfRoom&) { // a run of one leaf did not fit beside the complex
      }
    }
    on_host_ = true;
    return contour::make_dual(in, on_phase);
  }
  /// Whether the last one did not fit and was made by the host.
  bool on_host() const { return on_host_; }
  int64_t runs() const { return runs_; }

  /// At most taken at once before the elements, which come in runs as large as the rest allows.
  static int64_t bytes(const contour::DualInput& in) {
    const auto leaves = int64_t{in.tree.size()}, cells = static_cast<int64_t>(in.surface.cells.size());
    const int64_t points = leaves + leaves / 4 + 1024; // a leaf has about one corner of its own
    const int64_t complex = leaves * (1 + 32 + 4 + 4 + 28) + points * (28 + 12 + 8 + 1 + 4);
    const int64_t passes = std::max(leaves * (32 + 4 + 4) + points, cells * 200 + (leaves + points) * 9);
    return 24 * static_cast<int64_t>(in.tree.blocks().size()) + complex + passes;
  }

private:
  contour::Dual on_device(const contour::DualInput& in, const std::function<void(const std::string&)>& on_phase) {
    on_phase("dual vertices");
    contour::OctreeView tree = in.tree.view();
    tree.key = selected_.leaves.key.data();
    tree.level = selected_.leaves.level.data();
    tree.block = selected_.leaves.block.data();
    tree.large = selected_.leaves.large.data();
    const Array<uint32_t> slot = contour::detail::index_blocks(b_, selected_.leaves.block.n, tree);
    const auto& surface = selected_.surface;
    contour::detail::ComplexPasses<Backend> passes(b_, selected_.lattice->view, tree, surface.cells.data(),
                                                   surface.samples.data(), surface.cells.n);
    if (!in.lattice.cut_allowed() && passes.meets_wall())
      contour::refuse_surface_at_wall();
    on_phase("elements");
    ElementMaker<Backend> maker(b_);
    using Ids = typename ElementMaker<Backend>::Ids;
    contour::Dual dual;
    dual.restored_points = passes.restore_spoiling(
        [&](const Ids& leaves, const Ids* ends) { return maker.spoiled_of(passes.view, leaves, ends); });
    // On their way while the elements are made.
    const contour::ComplexView device = passes.view;
    auto side = b_.fetch(std::move(passes.side));
    auto grid_vertex = b_.fetch(std::move(passes.grid_vertex));
    auto first_cell = b_.fetch(std::move(passes.first_cell));
    auto split = b_.fetch(std::move(passes.split));
    auto split_leaf = b_.fetch(std::move(passes.split_leaf));
    auto value = b_.fetch(std::move(passes.value));
    auto point = b_.fetch(std::move(passes.point));
    auto nearest = b_.fetch(std::move(passes.nearest));
    dual.elements = maker(device);
    runs_ = maker.runs();

    contour::Complex& c = dual.complex;
    c.view = device;
    c.view.lattice = in.lattice.view();
    c.view.tree = in.tree.view();
    c.view.cells = in.surface.cells.data();
    c.view.samples = in.surface.samples.data();
    c.view.side = keep(c.side, side);
    c.view.grid_vertex = keep(c.grid_vertex, grid_vertex);
    c.view.first_cell = keep(c.first_cell, first_cell);
    c.view.split = keep(c.split, split);
    c.view.split_leaf = keep(c.split_leaf, split_leaf);
    c.view.value = keep(c.value, value);
    c.view.point = keep(c.point, point);
    c.view.nearest = keep(c.nearest, nearest);
    c.view.position = nullptr;
    c.view.distance = c.view.estimate = nullptr;
    c.view.has_moved = nullptr;
    LargeArray<Vec3d> position(static_cast<size_t>(device.vertices()) + dual.elements.position.size());
    b_.download(passes.position, device.vertices(), position.data());
    std::copy(dual.elements.position.begin(), dual.elements.position.end(), position.begin() + device.vertices());
    dual.elements.position = std::move(position);
    return dual;
  }

  template <class T, class Pending>
  static T* keep(LargeArray<T>& to, Pending& from) {
    const T* p = from.get();
    to.assign(p, p + from.size());
    return to.data();
  }
  Backend& b_;
  const Selection<Backend>& selected_;
  bool on_host_ = false;
  int64_t runs_ = 0;
};

} // namespace molmesh::cuda
