// unavailable.cpp — what the mode cuda answers in a build without CUDA.
#include "base/error.hpp"
#include "cuda/contour/contour.hpp"
#include "cuda/density/density.hpp"
#include "cuda/optimize/optimize.hpp"
#include "cuda/par/device.hpp"

namespace molmesh::cuda {

void require_device() {
  fail(Status::mode_unavailable, "mode cuda: not available in this build, use seq or omp", {"mode"});
}

int64_t device_memory() {
  return 0;
}

std::string device_name() {
  require_device();
  return {};
}

Band compute_density(const Hierarchy&, const density::Options&, density::Counts&, DeviceReport&, int64_t) {
  require_device();
  return {};
}

TetMesh contour_mesh(const BlockGrid&, const contour::Options&, contour::Summary&,
                     const std::function<void(const std::string&)>&, DeviceReport&, int64_t) {
  require_device();
  return {};
}

optimize::Result improve_mesh(TetMesh&, const BlockGrid*, const optimize::Options&,
                              const std::function<void(const std::string&)>&, DeviceReport&, int64_t) {
  require_device();
  return {};
}

} // namespace molmesh::cuda
