// main.cpp — what tests/gpu.sh runs on a machine with a GPU: parity of all stages, and their times.
//   molmesh_gpu [host] small [N]                     random small cases, every Nth; all stages against the host
//   molmesh_gpu [host] tiny                          one small case, all stages
//   molmesh_gpu [host] parity FILE.hier GRID [STAGE] one structure, the same
//   molmesh_gpu [host] time FILE.hier GRID STAGE REPEATS THREADS
//                                                    medians, and each kernel's share of the card's peak
// GRID: the spacing in Å, or nN for N points along the longest axis. STAGE: the last one, density, mesh or improve.
// THREADS: of the host beside the device. host: the device's algorithms on the host's threads, where there is no
// GPU; its times are no device's.
#include "base/error.hpp"
#include "cuda/par/device.hpp"
#include "formats/hier/hier.hpp"
#include "par/par.hpp"
#include "parity.hpp"
#include "times.hpp"
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>

using namespace molmesh;

namespace {

Hierarchy read(const char* file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    fail_input(std::string(file) + ": cannot read");
  return formats::read_hier(in, file);
}

gpu::Stage stage(const std::string& name) {
  if (name == "density")
    return gpu::Stage::density;
  if (name == "mesh")
    return gpu::Stage::mesh;
  if (name != "improve")
    fail(Status::usage, name + ": expected density, mesh or improve");
  return gpu::Stage::improve;
}

int run(int argc, char** argv) {
  gpu::How device{gpu::By::device, par::default_threads()};
  gpu::How reference{gpu::By::host, device.threads};
  if (argc > 1 && std::strcmp(argv[1], "host") == 0) {
    device.by = gpu::By::host_as_device;
    --argc, ++argv;
  }
  const std::string what = argc > 1 ? argv[1] : "";
  const bool on_file = (what == "parity" && (argc == 4 || argc == 5)) || (what == "time" && argc == 7);
  if (!on_file && !(what == "small" && argc <= 3) && !(what == "tiny" && argc == 2))
    fail(Status::usage,
         "expected [host] and small [N], tiny, parity FILE GRID [STAGE] or time FILE GRID STAGE REPEATS THREADS");
  const gpu::Stage last = on_file && argc > 4 ? stage(argv[4]) : gpu::Stage::improve;
  std::printf("%s\n", device.by == gpu::By::device ? cuda::device_name().c_str() : "the host, as a device");
  density::Options o;
  if (on_file && argv[3][0] == 'n')
    o.grid_points = std::stoi(argv[3] + 1);
  else if (on_file)
    o.spacing = std::stod(argv[3]);
  o.threads = par::default_threads();
  gpu::Parity parity(device, reference);
  if (what == "tiny")
    parity.tiny();
  else if (what == "small")
    parity.small(argc == 3 ? std::max(1, std::stoi(argv[2])) : 1);
  else if (const Hierarchy h = read(argv[2]); what == "parity")
    parity.slabs(argv[2], h, o, false), parity.structure(argv[2], h, o, last);
  else {
    reference.threads = std::max(1, std::stoi(argv[6]));
    gpu::time_all(h, o, last, std::stoi(argv[5]), device, reference);
  }
  return parity.failures() > 0;
}

} // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Error& e) {
    std::fprintf(stderr, "molmesh_gpu: %s\n", e.what());
    return static_cast<int>(e.status);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "molmesh_gpu: %s\n", e.what());
    return 1;
  }
}
