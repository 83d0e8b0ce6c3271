// optimize.cu — the flow on the GPU.
#include "cuda/optimize/geometric_flow.hpp"
#include "cuda/optimize/optimize.hpp"
#include "cuda/par/device.cuh"
#include <optional>

namespace molmesh::cuda {

optimize::Result improve_mesh(TetMesh& mesh, const BlockGrid* density, const optimize::Options& options,
                              const std::function<void(const std::string&)>& phase, DeviceReport& report,
                              int64_t most_bytes) {
  DeviceBackend backend(most_bytes, true);
  std::optional<Flow<DeviceBackend>> flow;
  const optimize::Result result =
      optimize::improve(mesh, density, options, phase,
                        [&](optimize::DynamicMesh& m, const Isosurface* surface, const optimize::Pass& pass) {
                          if (!flow)
                            flow.emplace(backend, surface, options.threads);
                          return flow->run(m, pass, flow_sweeps);
                        });
  flow.reset();
  report = report_of(backend, device_name());
  return result;
}

} // namespace molmesh::cuda
