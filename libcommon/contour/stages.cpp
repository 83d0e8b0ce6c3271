// stages.cpp — the stages on the host's threads.
#include "contour/stages.hpp"
#include "contour/assembly/assembly.hpp"
#include "contour/relaxation/relax.hpp"
#include "isosurface/isosurface.hpp"
#include "par/par.hpp"

namespace molmesh::contour {

void HostStages::find_surface(const Lattice& lattice) {
  lattice_ = &lattice;
  surface_ = contour::find_surface(lattice, threads_);
}

void HostStages::select_leaves(const RefineOptions& options) {
  tree_.emplace(lattice_->cells, contour::select_leaves(*lattice_, surface_, options, threads_), threads_);
}

void HostStages::make_dual(Side unmeshed, const std::function<void(const std::string&)>& on_phase) {
  dual_ = contour::make_dual({*lattice_, *tree_, surface_, unmeshed, threads_}, on_phase);
  // Nothing needs these any more: relaxation's arrays take their memory.
  surface_.samples = LargeArray<SurfaceSample>();
  dual_.complex.position = LargeArray<Vec3d>();
  dual_.complex.beside = LargeArray<int32_t>();
  ComplexView& view = dual_.complex.view;
  view.samples = nullptr;
  view.position = nullptr;
  view.beside = nullptr;
}

void HostStages::relax() {
  const Isosurface surface(lattice_->grid(), threads_);
  relaxed_ = contour::relax(dual_.elements, lattice_classes(dual_.complex, threads_), &surface, threads_);
}

std::vector<Component> HostStages::find_regions(const RegionOptions& options) {
  regions_ = find_components(dual_.complex.view, dual_.elements, options, threads_);
  return regions_.component;
}

TetMesh HostStages::assemble(Options::Meshed meshed) {
  return contour::assemble(dual_.elements, regions_, meshed, threads_);
}

void HostStages::count(Summary& summary) const {
  summary.leaves = tree_->size();
  summary.surface_cells = static_cast<int64_t>(surface_.cells.size());
  const auto is_split = [&](int64_t leaf) { return dual_.complex.split[leaf] >= 0; };
  summary.split_cells = static_cast<int64_t>(par::select(tree_->size(), threads_, is_split).size());
  summary.restored_points = dual_.restored_points;
  summary.relaxed_points = relaxed_;
  summary.face_points = dual_.elements.face_points;
  summary.edge_points = dual_.elements.edge_points;
}

} // namespace molmesh::contour
