// contour.cu — density2tet's stages on the GPU.
#include "cuda/contour/contour.hpp"
#include "cuda/contour/device_stages.hpp"
#include "cuda/par/device.cuh"

namespace molmesh::cuda {

TetMesh contour_mesh(const BlockGrid& grid, const contour::Options& options, contour::Summary& summary,
                     const std::function<void(const std::string&)>& on_phase, DeviceReport& report,
                     int64_t most_bytes) {
  DeviceBackend backend(most_bytes, true);
  TetMesh mesh;
  {
    DeviceStages<DeviceBackend> stages(backend, options.threads);
    mesh = contour::contour(grid, options, summary, on_phase, stages);
  }
  report = report_of(backend, device_name());
  return mesh;
}

} // namespace molmesh::cuda
