// main.cpp — what tests/gpu.sh runs on a machine with a GPU: parity of all stages, and their times.
//   molmesh_gpu small                           random small cases, every stage against the host
//   molmesh_gpu parity FILE.hier SPACING        one structure, the same
//   molmesh_gpu time FILE.hier SPACING REPEATS  medians, phases, and each kernel's share of the card's peak
#include "cuda/par/device.hpp"
#include "error.hpp"
#include "formats/hier/hier.hpp"
#include "par/par.hpp"
#include "peaks.hpp"
#include "stages.hpp"
#include "unit/contour/sample_grid.hpp"
#include "unit/density/oracle.hpp"
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <random>

using namespace molmesh;

namespace {

int failures = 0;

void tell(const std::string& what, const std::string& fault) {
  std::printf("%-6s %s%s%s\n", fault.empty() ? "ok" : "FAILED", what.c_str(), fault.empty() ? "" : ": ",
              fault.c_str());
  std::fflush(stdout);
  failures += !fault.empty();
}

/// Every stage from the host's result of the stage before.
void parity(const std::string& name, const Hierarchy& h, const density::Options& o, bool all_stages) {
  const int threads = par::default_threads();
  gpu::Timed t;
  const BlockGrid host = gpu::run_density(h, o, false, threads, t),
                  device = gpu::run_density(h, o, true, threads, t);
  tell(name + ", density", gpu::compare_grids(h, device, host));
  if (!all_stages)
    return;
  for (const double adapt : {0.25, 0.0}) {
    contour::Options c;
    c.meshed = contour::Options::both;
    c.adapt = adapt;
    const TetMesh mesh = gpu::run_contour(host, c, false, threads, t),
                  same = gpu::run_contour(host, c, true, threads, t);
    tell(name + ", mesh, --adapt " + std::to_string(adapt), gpu::compare_meshes(same, mesh, 0));
    if (!t.device.note.empty())
      std::printf("       %s\n", t.device.note.c_str());
    if (adapt == 0)
      continue;
    const TetMesh better = gpu::run_improve(mesh, host, false, threads, t),
                  device_better = gpu::run_improve(mesh, host, true, threads, t);
    tell(name + ", improved", gpu::compare_meshes(device_better, better, 1e-6));
    tell(name + ", improved, valid", gpu::check_valid(device_better));
  }
}

/// Ambiguous cells, ties, both regions, cut boxes: connectivity and positions to the last bit.
void random_grids() {
  std::mt19937_64 random(5);
  int64_t tets = 0;
  std::string fault;
  for (int trial = 0; trial < 24; ++trial) {
    const BlockGrid grid = test::random_grid(random, trial);
    for (const double adapt : {0.0, 0.3})
      for (const bool cut : {false, true}) {
        contour::Options c;
        c.meshed = contour::Options::both;
        c.adapt = adapt;
        if (cut) { // a quarter of a spacing within the grid
          const Vec3d last = grid.frame.position(grid.frame.lower + grid.frame.points - Vec3i{1, 1, 1});
          const double in = 1.25 * grid.frame.spacing;
          c.box.kind = contour::BoxRequest::corners;
          c.box.lower = grid.frame.position(grid.frame.lower) + Vec3d{in, in, in};
          c.box.upper = last - Vec3d{in, in, in};
        }
        gpu::Timed t;
        const TetMesh host = gpu::run_contour(grid, c, false, 1, t), device = gpu::run_contour(grid, c, true, 1, t);
        tets += static_cast<int64_t>(host.tet.size());
        if (fault.empty())
          fault = t.device.note.empty() ? gpu::compare_meshes(device, host, 0) : t.device.note;
      }
  }
  tell("96 meshes of random grids, " + std::to_string(tets) + " tetrahedra, to the last bit", fault);
}

void small() {
  random_grids();
  const std::vector<std::vector<double>> settings = {{}, {0.5, 1}, {0.3, 1}, {0.05, 0.5}, {2, 1}, {0.8, 0.5, 1}};
  for (size_t i = 0; i < settings.size(); ++i)
    for (const double tolerance : {1e-4, 1e-6}) {
      density::Options o;
      o.spacing = 0.8;
      o.tolerance = tolerance;
      parity("random " + std::to_string(i) + ", tolerance " + std::to_string(tolerance),
             test::random_chains(3, 12, 6, settings[i], 17 + static_cast<unsigned>(i)), o, tolerance == 1e-4);
    }
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

/// Runs fewer times than asked where one takes minutes.
template <class Run>
void time_stage(const char* stage, const char* mode, int repeats, const gpu::Peaks& peaks, Run run) {
  std::vector<double> wall;
  std::vector<std::vector<double>> kernel;
  gpu::Timed t;
  for (int i = 0; i < repeats && (wall.empty() || wall.size() * wall.back() < 60); ++i) {
    t = {};
    run(t);
    wall.push_back(t.seconds);
    kernel.resize(std::max(kernel.size(), t.device.kernels.size()));
    for (size_t k = 0; k < t.device.kernels.size(); ++k)
      kernel[k].push_back(t.device.kernels[k].seconds);
  }
  double kernels = 0, copies = 0;
  for (size_t k = 0; k < t.device.kernels.size(); ++k)
    (t.device.kernels[k].name.rfind("copies", 0) == 0 ? copies : kernels) += median(kernel[k]);
  std::printf("%-8s %-5s %10.4f s", stage, mode, median(wall));
  if (std::strcmp(mode, "cuda") != 0) {
    std::printf("\n");
    return;
  }
  if (!t.device.note.empty())
    std::printf("   (%s)", t.device.note.c_str());
  std::printf("   kernels %.4f s, copies %.4f s, at most %.1f MiB on the device, %zu runs\n", kernels, copies,
              double(t.device.most_bytes) / 1048576, wall.size());
  for (size_t k = 0; k < t.device.kernels.size(); ++k) {
    const cuda::KernelTime& n = t.device.kernels[k];
    const double s = median(kernel[k]);
    std::printf("    %-28s %6lld launches %9.3f ms  %5.1f %% of the bandwidth  %5.1f %% of the multiply-adds\n",
                n.name.c_str(), static_cast<long long>(n.launches), 1e3 * s, 100 * n.work.bytes / s / peaks.bytes,
                100 * n.work.multiply_adds / s / (n.work.in_double ? peaks.in_double : peaks.single));
  }
  std::fflush(stdout);
}

void time_all(const Hierarchy& h, const density::Options& o, int repeats) {
  const gpu::Peaks peaks = gpu::measure_peaks();
  std::printf("this card, measured: %.0f GB/s copied, %.1f T multiply-adds/s in single, %.1f in double precision\n",
              1e-9 * peaks.bytes, 1e-12 * peaks.single, 1e-12 * peaks.in_double);
  const int threads = par::default_threads();
  BlockGrid grid;
  TetMesh mesh;
  contour::Options c;
  c.meshed = contour::Options::both;
  time_stage("density", "cuda", repeats, peaks,
             [&](gpu::Timed& t) { grid = gpu::run_density(h, o, true, threads, t); });
  for (const double adapt : {contour::Options{}.adapt, 0.0}) {
    c.adapt = adapt;
    std::printf("--adapt %g\n", adapt);
    time_stage("mesh", "seq", repeats, peaks,
               [&](gpu::Timed& t) { mesh = gpu::run_contour(grid, c, false, 1, t); });
    time_stage("mesh", "omp", repeats, peaks,
               [&](gpu::Timed& t) { mesh = gpu::run_contour(grid, c, false, threads, t); });
    time_stage("mesh", "cuda", repeats, peaks,
               [&](gpu::Timed& t) { mesh = gpu::run_contour(grid, c, true, threads, t); });
    std::printf("         %zu tetrahedra, %zu points; %d threads of the host\n", mesh.tet.size(), mesh.point.size(),
                threads);
  }
  time_stage("improve", "cuda", 1, peaks, [&](gpu::Timed& t) { gpu::run_improve(mesh, grid, true, threads, t); });
}

Hierarchy read(const char* file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    fail_input(std::string(file) + ": cannot read");
  return formats::read_hier(in, file);
}

int run(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const bool on_file = (what == "parity" && argc == 4) || (what == "time" && argc == 5);
  if (!on_file && !(what == "small" && argc == 2))
    fail(Status::usage, "expected small, parity FILE SPACING or time FILE SPACING REPEATS");
  std::printf("%s\n", cuda::device_name().c_str());
  density::Options o;
  if (on_file)
    o.spacing = std::stod(argv[3]);
  o.threads = par::default_threads();
  if (what == "small")
    small();
  else if (what == "parity")
    parity(argv[2], read(argv[2]), o, true);
  else
    time_all(read(argv[2]), o, std::stoi(argv[4]));
  return failures > 0;
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
