// stages.hpp — each stage on the GPU, by the same algorithms on the host, and as the host itself does it.
#pragma once
#include "contour/contour.hpp"
#include "cuda/par/backend.hpp"
#include "density/density.hpp"
#include "mesh/tet_mesh.hpp"
#include <string>
#include <vector>

namespace molmesh::gpu {

enum class Stage { density, mesh, improve };
enum class By {
  host,
  device,
  host_as_device, ///< the device's algorithms on the host's threads
};
struct How {
  By by = By::host;
  int threads = 1;        ///< of the host
  int64_t most_bytes = 0; ///< of the device's memory; 0: all
  bool flow = true;       ///< false: improvement as omp does it
};

/// One run of a stage.
struct Timed {
  double seconds = 0; ///< wall clock, of the whole stage
  struct Phase {
    std::string name;
    double begin; ///< seconds
  };
  std::vector<Phase> phases; ///< of the mesh and its improvement
  cuda::DeviceReport device;
};

/// By::host is as host_as_device, but for run_contour: what the host does needs Highway, or has no flow.
BlockGrid run_density(const Hierarchy& h, const density::Options& o, const How& how, Timed& time);
TetMesh run_contour(const BlockGrid& grid, const contour::Options& o, const How& how, Timed& time);
TetMesh run_improve(const TetMesh& mesh, const BlockGrid& grid, const How& how, Timed& time);

/// Empty, or what is wrong with the GPU's results.
std::string compare_grids(const Hierarchy& h, const BlockGrid& device, const BlockGrid& host);
std::string compare_meshes(const TetMesh& device, const TetMesh& host, double tolerance);
std::string check_valid(const TetMesh& mesh);

} // namespace molmesh::gpu
