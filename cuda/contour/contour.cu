// contour.cu — density2tet's stages on the GPU.
#include "cuda/contour/contour.hpp"
#include "cuda/contour/device_stages.hpp"
#include "cuda/par/device.cuh"

namespace molmesh::cuda {

TetMesh contour_mesh(const BlockGrid& grid, const contour::Options& options, contour::Summary& summary,
                     const std::function<void(const std::string&)>& on_phase, DeviceReport& report) {
  DeviceBackend backend;
  TetMesh mesh;
  std::string note;
  try {
    DeviceStages<DeviceBackend> stages(backend, options.threads);
    mesh = contour::contour(grid, options, summary, on_phase, stages);
    note = stages.note();
  } catch (const OutOfRoom& e) {
    note = "all made by the host: " + std::string(e.what());
    summary = {};
    mesh = contour::contour(grid, options, summary, on_phase);
  }
  report = {device_name(), backend.most_used(), backend.times(), note};
  return mesh;
}

} // namespace molmesh::cuda
