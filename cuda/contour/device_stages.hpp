// device_stages.hpp — contour::Stages on a Backend, by the host's own passes and functions: the same mesh.
// Everything stays in the Backend's memory up to the mesh; where it does not fit, the host goes on.
#pragma once
#include "contour/detail/assembly_passes.hpp"
#include "contour/detail/complex_passes.hpp"
#include "contour/detail/octree_index.hpp"
#include "contour/detail/region_passes.hpp"
#include "contour/stages.hpp"
#include "cuda/contour/device_mesh.hpp"
#include "cuda/contour/elements.hpp"
#include "cuda/contour/relax.hpp"
#include "cuda/contour/selection.hpp"
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace molmesh::cuda {

template <class Backend>
class DeviceStages final : public contour::Stages {
  template <class T>
  using Array = typename Backend::template Array<T>;
  using Complex = contour::detail::ComplexPasses<Backend>;
  using Ids = typename ElementMaker<Backend>::Ids;

public:
  /// threads: of the host, for what the device has no room for.
  DeviceStages(Backend& b, int threads) : b_(b), threads_(threads), selection_(b), maker_(b) {}

  /// Throws OutOfRoom, as select_leaves does: then nothing is left.
  void find_surface(const contour::Lattice& lattice) override {
    lattice_ = &lattice;
    selection_.find_surface(lattice);
  }
  void select_leaves(const contour::RefineOptions& options) override {
    selection_.select_leaves(*lattice_, options);
  }
  void make_dual(const std::function<void(const std::string&)>& on_phase) override {
    if (complex_bytes() > b_.room())
      return host_from_leaves(on_phase);
    try {
      make_complex(on_phase);
    } catch (const OutOfRoom&) { // a run of one leaf did not fit beside the complex
      return host_from_leaves(on_phase);
    }
    try {
      SinkOnDevice<Backend> sink(b_);
      const auto made = maker_(complex_->view, sink);
      elements_ = sink.elements(complex_->view);
      elements_.face_points = made.face_points;
      elements_.edge_points = made.edge_points;
      if (bytes_after_elements() <= b_.room())
        return;
    } catch (const OutOfRoom&) {
    }
    elements_ = {};
    try {
      host_from_runs();
    } catch (const OutOfRoom&) {
      host_from_leaves(on_phase);
    }
  }
  void relax() override {
    step([&] { relax_on_device(); }, [&] { host_->relax(); });
    is_relaxed_ = true;
  }
  std::vector<contour::Component> find_regions(const contour::RegionOptions& options) override {
    std::vector<contour::Component> parts;
    step(
        [&] {
          regions_.emplace(b_, complex_->view, elements_.view(), options);
          parts = regions_->component;
        },
        [&] { parts = host_->find_regions(options); });
    options_ = options;
    return parts;
  }
  TetMesh assemble(contour::Options::Meshed meshed) override {
    TetMesh mesh;
    step(
        [&] {
          DeviceMesh<Backend> room(b_);
          contour::detail::assemble(b_, elements_.view(), regions_->region.data(), regions_->region.size(),
                                    contour::detail::wanted(meshed), room);
          mesh = room.on_host();
        },
        [&] {
          if (regions_)
            host_->find_regions(options_);
          mesh = host_->assemble(meshed);
        });
    return mesh;
  }
  void count(contour::Summary& summary) const override {
    if (host_)
      return host_->count(summary);
    summary.leaves = selection_.leaves.key.n;
    summary.surface_cells = selection_.surface.cells.n;
    summary.split_cells = split_cells_;
    summary.restored_points = restored_;
    summary.relaxed_points = relaxed_;
    summary.face_points = elements_.face_points;
    summary.edge_points = elements_.edge_points;
  }

  /// What the host did for want of room; empty: nothing.
  const std::string& note() const { return note_; }
  int64_t runs() const { return maker_.runs(); }
  /// While on the device, for tests.
  const contour::ElementArrays<Backend>& elements() const { return elements_; }
  const contour::HostStages* host() const { return host_.get(); }

private:
  /// At most taken at once before the elements.
  int64_t complex_bytes() const {
    const int64_t leaves = selection_.leaves.key.n, cells = selection_.surface.cells.n;
    const int64_t points = leaves + leaves / 4 + 1024; // a leaf has about one corner of its own
    const int64_t complex = leaves * (1 + 32 + 4 + 4 + 28) + points * (28 + 12 + 8 + 1 + 4);
    const int64_t passes = std::max(leaves * (32 + 4 + 4) + points, cells * 200 + (leaves + points) * 9);
    return 24 * selection_.leaves.block.n + complex + passes;
  }
  /// Beside complex and elements: relaxation's stars as if a sixth of the elements were bad, or the mesh as it is
  /// put in order.
  int64_t bytes_after_elements() const {
    const int64_t tets = elements_.tet.size(), points = elements_.position.size();
    const BlockGrid& grid = lattice_->grid();
    const int64_t relaxation =
                      4 * tets + 9 * points + tets / 6 * 4 * 84 + 5 * static_cast<int64_t>(grid.value.size()),
                  assembly = 41 * tets + 34 * points + 32 * elements_.tri.size();
    return std::max(relaxation, assembly);
  }

  void make_complex(const std::function<void(const std::string&)>& on_phase) {
    on_phase("dual vertices");
    const contour::LatticeView& lattice = selection_.lattice->view;
    contour::OctreeView tree;
    const auto& leaves = selection_.leaves;
    tree.cells = lattice.cells;
    tree.leaves = static_cast<int32_t>(leaves.key.n);
    tree.key = leaves.key.data();
    tree.level = leaves.level.data();
    tree.block = leaves.block.data();
    tree.large = leaves.large.data();
    tree.large_leaves = static_cast<int32_t>(leaves.large.n);
    slot_ = contour::detail::index_blocks(b_, leaves.block.n, tree);
    const auto& surface = selection_.surface;
    complex_.emplace(b_, lattice, tree, surface.cells.data(), surface.samples.data(), surface.cells.n);
    if (!lattice_->cut_allowed() && complex_->meets_wall())
      contour::refuse_surface_at_wall();
    on_phase("elements");
    restored_ = complex_->restore_spoiling(
        [&](const Ids& near, const Ids* ends) { return maker_.spoiled_of(complex_->view, near, ends); });
    split_cells_ = contour::detail::gather<int32_t>(b_, "split cells", tree.leaves,
                                                    contour::detail::SplitLeaves{complex_->view})
                       .n;
  }

  void relax_on_device() {
    const improve::Isosurface surface(lattice_->grid(), threads_);
    TeamMover<Backend> mover(b_, surface);
    const int64_t known = complex_->view.vertices();
    auto lattice_class = b_.template array<uint8_t>(known);
    b_.for_n("lattice classes", known, contour::detail::LatticeClasses{complex_->view, lattice_class.data()},
             {double(known) * 6});
    relaxed_ = contour::detail::RelaxPasses<Backend, TeamMover<Backend>>(b_, elements_.view(), lattice_class.data(),
                                                                         known, true, mover)
                   .run();
  }

  /// On the device where everything is there; what does not fit is made anew by the host, with all before it.
  template <class Device, class Host>
  void step(Device device, Host host) {
    if (!host_) {
      try {
        return device();
      } catch (const OutOfRoom&) {
        host_from_leaves([](const std::string&) {});
        if (is_relaxed_)
          host_->relax();
      }
    }
    host();
  }

  /// Nothing but surface and leaves is kept.
  void host_from_leaves(const std::function<void(const std::string&)>& on_phase) {
    elements_ = {};
    complex_.reset();
    host_ = std::make_unique<contour::HostStages>(threads_, *lattice_, selection_.surface_on_host(),
                                                  selection_.leaves_on_host());
    host_->make_dual(on_phase);
    note_ = "dual vertices, elements, relaxation, regions and assembly did not fit the device: made by the host";
  }
  /// Elements come run by run, and the complex beside them.
  void host_from_runs() {
    host_ = std::make_unique<contour::HostStages>(threads_, *lattice_, selection_.surface_on_host(),
                                                  selection_.leaves_on_host(),
                                                  [&](const contour::DualInput& in) { return dual_on_host(in); });
    complex_.reset();
    note_ = "relaxation, regions and assembly did not fit the device: made by the host";
  }
  contour::Dual dual_on_host(const contour::DualInput& in) {
    SinkToHost<Backend> sink(b_);
    const contour::ComplexView device = complex_->view;
    const auto made = maker_(device, sink);
    contour::Dual dual;
    dual.restored_points = restored_;
    contour::Complex& c = dual.complex;
    c.view = device;
    c.view.lattice = in.lattice.view();
    c.view.tree = in.tree.view();
    c.view.cells = in.surface.cells.data();
    c.view.samples = in.surface.samples.data();
    c.view.side = keep(c.side, complex_->side);
    c.view.grid_vertex = keep(c.grid_vertex, complex_->grid_vertex);
    c.view.first_cell = keep(c.first_cell, complex_->first_cell);
    c.view.split = keep(c.split, complex_->split);
    c.view.split_leaf = keep(c.split_leaf, complex_->split_leaf);
    c.view.value = keep(c.value, complex_->value);
    c.view.point = keep(c.point, complex_->point);
    c.view.nearest = keep(c.nearest, complex_->nearest);
    c.view.position = nullptr;
    c.view.distance = c.view.estimate = nullptr;
    c.view.has_moved = nullptr;
    contour::Elements& e = dual.elements;
    e = std::move(sink.elements);
    e.face_points = made.face_points;
    e.edge_points = made.edge_points;
    LargeArray<Vec3d> position(static_cast<size_t>(device.vertices()) + e.position.size());
    b_.download(complex_->position, device.vertices(), position.data());
    std::copy(e.position.begin(), e.position.end(), position.begin() + device.vertices());
    e.position = std::move(position);
    return dual;
  }
  template <class T>
  T* keep(LargeArray<T>& to, const Array<T>& from) {
    to.resize(static_cast<size_t>(from.size()));
    b_.download(from, from.size(), to.data());
    return to.data();
  }

  Backend& b_;
  int threads_;
  const contour::Lattice* lattice_ = nullptr;
  Selection<Backend> selection_;
  ElementMaker<Backend> maker_;
  Array<uint32_t> slot_;
  std::optional<Complex> complex_;
  contour::ElementArrays<Backend> elements_;
  std::optional<contour::detail::RegionPasses<Backend>> regions_;
  contour::RegionOptions options_;
  int64_t restored_ = 0, split_cells_ = 0, relaxed_ = 0;
  bool is_relaxed_ = false;
  std::unique_ptr<contour::HostStages> host_;
  std::string note_;
};

} // namespace molmesh::cuda
