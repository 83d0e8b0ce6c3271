// density.cu — runs the neighboring search on the GPU.
#include "cuda/density/density.hpp"
#include "cuda/density/neighboring_search.hpp"
#include "cuda/par/device.cuh"

namespace molmesh::cuda {

Band compute_density(const Hierarchy& h, const density::Options& options, density::Counts& counts,
                     DeviceReport& report, int64_t most_bytes) {
  DeviceBackend backend(most_bytes);
  const auto find = [&](const density::Field& f, const GridFrame& frame, const density::SearchOptions& o,
                        density::SearchCounts& c) { return Search<DeviceBackend>(backend, f, frame, o).run(c); };
  Band band = density::compute(h, options, counts, find);
  report = report_of(backend, device_name());
  return band;
}

} // namespace molmesh::cuda
