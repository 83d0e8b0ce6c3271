// contour.cu — the elements on the GPU.
#include "cuda/contour/contour.hpp"
#include "cuda/contour/elements.hpp"
#include "cuda/par/device.cuh"

namespace molmesh::cuda {

TetMesh contour_mesh(const BlockGrid& grid, const contour::Options& options, contour::Summary& summary,
                     const std::function<void(const std::string&)>& on_phase, DeviceReport& report) {
  DeviceBackend backend;
  ElementMaker<DeviceBackend> maker(backend);
  TetMesh mesh = contour::contour(
      grid, options, summary, on_phase,
      [&](const contour::Complex& c, bool inside, bool outside, int) { return maker(c, inside, outside); });
  report = {device_name(), backend.most_used(), backend.times()};
  return mesh;
}

} // namespace molmesh::cuda
