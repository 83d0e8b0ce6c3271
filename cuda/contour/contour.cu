// contour.cu — surface cells, leaves, complex and elements on the GPU.
#include "cuda/contour/contour.hpp"
#include "cuda/contour/dual.hpp"
#include "cuda/contour/selection.hpp"
#include "cuda/par/device.cuh"

namespace molmesh::cuda {

TetMesh contour_mesh(const BlockGrid& grid, const contour::Options& options, contour::Summary& summary,
                     const std::function<void(const std::string&)>& on_phase, DeviceReport& report) {
  DeviceBackend backend;
  Selection<DeviceBackend> selection(backend);
  DualMaker<DeviceBackend> maker(backend, selection);
  contour::Stages stages;
  stages.find_surface = [&](const contour::Lattice& l, int) { return selection.find_surface(l); };
  stages.select_leaves = [&](const contour::Lattice& l, const contour::Surface&, const contour::RefineOptions& o,
                             int) { return selection.select_leaves(l, o); };
  stages.make_dual = [&](const contour::DualInput& in, const auto& phase) { return maker(in, phase); };
  TetMesh mesh;
  std::string note;
  try {
    mesh = contour::contour(grid, options, summary, on_phase, stages);
    if (maker.on_host())
      note = "dual vertices and elements did not fit the device: made by the host";
  } catch (const OutOfRoom& e) {
    note = "all made by the host: " + std::string(e.what());
    summary = {};
    mesh = contour::contour(grid, options, summary, on_phase);
  }
  report = {device_name(), backend.most_used(), backend.times(), note};
  return mesh;
}

} // namespace molmesh::cuda
