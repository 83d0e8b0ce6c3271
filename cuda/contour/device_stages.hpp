// device_stages.hpp — contour::Stages on a Backend, by the host's own passes: the same mesh. Everything stays in
// the Backend's memory up to the mesh.
#pragma once
#include "contour/assembly/assembly_passes.hpp"
#include "contour/complex/complex_passes.hpp"
#include "contour/octree/octree_index.hpp"
#include "contour/regions/region_passes.hpp"
#include "contour/stages.hpp"
#include "cuda/contour/device_mesh.hpp"
#include "cuda/contour/elements.hpp"
#include "cuda/contour/leaves.hpp"
#include "cuda/contour/relax.hpp"
#include <algorithm>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace molmesh::cuda {

template <par::Launcher Backend>
class DeviceStages final : public contour::Stages {
  template <class T>
  using Array = typename Backend::template Array<T>;
  using Complex = contour::ComplexPasses<Backend>;
  using Ids = typename ElementMaker<Backend>::Ids;

public:
  /// threads: of the host. least_run: leaves, or edges, that are made elements of at once, however little room.
  /// copy_bytes: of a run of the mesh on its way to the host.
  DeviceStages(Backend& b, int threads, int64_t least_run = int64_t{1} << 16,
               int64_t copy_bytes = RunCopy<Backend>::usual_bytes)
      : b_(b), threads_(threads), copy_bytes_(copy_bytes), selection_(b), maker_(b, least_run) {}

  void find_surface(const contour::Lattice& lattice) override {
    lattice_ = &lattice;
    // The host's logarithms, beside the kernels up to the elements.
    isosurface_ = std::async(std::launch::async, [&grid = lattice.grid(), threads = threads_] {
      return std::make_unique<const Isosurface>(grid, threads); // until release_grid()
    });
    b_.plan(40 * static_cast<int64_t>(lattice.grid().value.size())); // with as many surface cells as usual
    selection_.find_surface(lattice);
  }
  void release_grid() noexcept override {
    if (isosurface_.valid())
      isosurface_.wait();
  }
  void select_leaves(const contour::RefineOptions& options) override {
    selection_.select_leaves(*lattice_, options);
  }
  void make_dual(contour::Side unmeshed, const std::function<void(const std::string&)>& on_phase) override {
    // A leaf has about twelve elements; they are there twice when runs are put together.
    const int64_t leaves = selection_.leaves.key.n, tets = 12 * leaves, tris = 2 * selection_.surface.cells.n;
    b_.plan(complex_bytes() + tets * tet_bytes + tris * 28 +
            std::max(tets * tet_bytes, most_beside(tets, 2 * leaves, tris)));
    make_complex(unmeshed, on_phase);
    SinkOnDevice<Backend> sink(b_);
    const auto made = maker_(complex_->view, sink);
    elements_ = sink.elements(complex_->view);
    elements_.face_points = made.face_points;
    elements_.edge_points = made.edge_points;
    b_.plan(most_beside(elements_.tet.size(), elements_.position.size(), elements_.tri.size()));
  }
  void relax() override {
    const std::unique_ptr<const Isosurface> surface = isosurface_.get();
    TeamMover<Backend> mover(b_, *surface);
    const int64_t known = complex_->view.vertices();
    auto lattice_class = b_.template array<uint8_t>(known);
    b_.for_n("lattice classes", known, contour::LatticeClasses{complex_->view, lattice_class.data()},
             {double(known) * 6});
    using Passes = contour::RelaxPasses<Backend, contour::ElementArrays<Backend>, TeamMover<Backend>>;
    relaxed_ = Passes(b_, elements_, lattice_class.data(), known, true, mover).run();
  }
  std::vector<contour::Component> find_regions(const contour::RegionOptions& options) override {
    regions_.emplace(b_, complex_->view, elements_.view(), options);
    return regions_->component;
  }
  TetMesh assemble(contour::Options::Meshed meshed) override {
    DeviceMesh<Backend> mesh(b_, threads_, copy_bytes_);
    contour::assemble(b_, elements_.view(), regions_->region.data(), regions_->region.size(),
                      contour::wanted(meshed), mesh);
    return mesh.on_host();
  }
  void count(contour::Summary& summary) const override {
    summary.leaves = selection_.leaves.key.n;
    summary.surface_cells = selection_.surface.cells.n;
    summary.split_cells = split_cells_;
    summary.restored_points = restored_;
    summary.relaxed_points = relaxed_;
    summary.face_points = elements_.face_points;
    summary.edge_points = elements_.edge_points;
  }

  int64_t runs() const { return maker_.runs(); }
  /// For tests.
  const contour::ElementArrays<Backend>& elements() const { return elements_; }

private:
  static constexpr int64_t tet_bytes = sizeof(Tet);
  /// At most taken at once before the elements.
  int64_t complex_bytes() const {
    const int64_t leaves = selection_.leaves.key.n, cells = selection_.surface.cells.n;
    const int64_t points = leaves + leaves / 4 + 1024; // a leaf has about one corner of its own
    const int64_t complex = leaves * (1 + 32 + 24 + 4 + 4 + 28) + points * (28 + 12 + 8 + 1 + 4);
    const int64_t passes = std::max(leaves * (32 + 4 + 4) + points, cells * 200 + (leaves + points) * 9);
    return 24 * selection_.leaves.block.n + complex + passes;
  }
  /// Beside complex and elements: relaxation's stars as if a sixth of the elements were bad, or the mesh as it is
  /// put in order.
  int64_t most_beside(int64_t tets, int64_t points, int64_t tris) const {
    const auto values = static_cast<int64_t>(lattice_->grid().value.size());
    const int64_t relaxation = 4 * tets + 9 * points + tets / 6 * 4 * 84 + 5 * values;
    const int64_t assembly = 41 * tets + 34 * points + 32 * tris;
    return std::max(relaxation, assembly);
  }

  void make_complex(contour::Side unmeshed, const std::function<void(const std::string&)>& on_phase) {
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
    slot_ = contour::index_leaves(b_, leaves.block.n, tree);
    const auto& surface = selection_.surface;
    complex_.emplace(b_, lattice, tree, surface.cells.data(), surface.samples.data(), surface.cells.n);
    complex_->view.unmeshed = unmeshed;
    if (!lattice_->cut_allowed() && complex_->meets_wall())
      contour::refuse_surface_at_wall();
    on_phase("elements");
    restored_ = complex_->restore_spoiling(
        [&](const Ids& near, const Ids* ends) { return maker_.spoiled_of(complex_->view, near, ends); });
    split_cells_ = par::gather<int32_t>(b_, "split cells", tree.leaves, contour::SplitLeaves{complex_->view}).n;
  }

  Backend& b_;
  int threads_;
  int64_t copy_bytes_;
  const contour::Lattice* lattice_ = nullptr;
  std::future<std::unique_ptr<const Isosurface>> isosurface_;
  DeviceLeaves<Backend> selection_;
  ElementMaker<Backend> maker_;
  Array<uint32_t> slot_;
  std::optional<Complex> complex_;
  contour::ElementArrays<Backend> elements_;
  std::optional<contour::RegionPasses<Backend>> regions_;
  int64_t restored_ = 0, relaxed_ = 0, split_cells_ = 0;
};

} // namespace molmesh::cuda
