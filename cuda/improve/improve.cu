// improve.cu — the flow on the GPU.
#include "cuda/improve/flow.hpp"
#include "cuda/improve/improve.hpp"
#include "cuda/par/device.cuh"
#include <optional>

namespace molmesh::cuda {

improve::Result improve_mesh(TetMesh& mesh, const BlockGrid* density, const improve::Options& options,
                             const std::function<void(const std::string&)>& phase, DeviceReport& report) {
  DeviceBackend backend;
  std::optional<Flow<DeviceBackend>> flow;
  const improve::Result result =
      improve::improve(mesh, density, options, phase,
                       [&](improve::DynamicMesh& m, const improve::Isosurface* surface, const improve::Pass& pass) {
                         if (!flow)
                           flow.emplace(backend, surface);
                         return flow->run(m, pass, flow_sweeps);
                       });
  report = {device_name(), backend.most_used(), backend.times()};
  return result;
}

} // namespace molmesh::cuda
