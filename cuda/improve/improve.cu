// improve.cu — the flow on the GPU.
#include "cuda/improve/flow.hpp"
#include "cuda/improve/improve.hpp"
#include "cuda/par/device.cuh"
#include <optional>

namespace molmesh::cuda {

improve::Result improve_mesh(TetMesh& mesh, const BlockGrid* density, const improve::Options& options,
                             const std::function<void(const std::string&)>& phase, DeviceReport& report,
                             int64_t most_bytes) {
  DeviceBackend backend(most_bytes, true);
  std::optional<Flow<DeviceBackend>> flow;
  const improve::Result result =
      improve::improve(mesh, density, options, phase,
                       [&](improve::DynamicMesh& m, const improve::Isosurface* surface, const improve::Pass& pass) {
                         if (!flow)
                           flow.emplace(backend, surface, options.threads);
                         return flow->run(m, pass, flow_sweeps);
                       });
  flow.reset();
  report = report_of(backend, device_name());
  return result;
}

} // namespace molmesh::cuda
