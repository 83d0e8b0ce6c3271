// stages.hpp — each stage on the GPU and by the same algorithms on the host, from the same input.
#pragma once
#include "contour/contour.hpp"
#include "cuda/par/backend.hpp"
#include "density/density.hpp"
#include "mesh/tet_mesh.hpp"
#include <string>
#include <vector>

namespace molmesh::gpu {

/// One run of a stage.
struct Timed {
  double seconds = 0; ///< wall clock, of the whole stage
  cuda::DeviceReport device;
};

/// device: on the GPU, else on `threads` of the host by HostBackend.
BlockGrid run_density(const Hierarchy& h, const density::Options& o, bool device, int threads, Timed& time);
TetMesh run_contour(const BlockGrid& grid, const contour::Options& o, bool device, int threads, Timed& time);
TetMesh run_improve(const TetMesh& mesh, const BlockGrid& grid, bool device, int threads, Timed& time);

/// Empty, or what is wrong with the GPU's results.
std::string compare_grids(const Hierarchy& h, const BlockGrid& device, const BlockGrid& host);
std::string compare_meshes(const TetMesh& device, const TetMesh& host, double tolerance);
std::string check_valid(const TetMesh& mesh);

} // namespace molmesh::gpu
