// times.cpp — medians of repeated runs, and each kernel beside what the card reaches.
#include "times.hpp"
#include "peaks.hpp"
#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>

namespace molmesh::gpu {
namespace {

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

/// Seconds that its work takes at the card's peaks.
double floor_of(const cuda::KernelTime& k, const Peaks& p) {
  return std::max(k.work.bytes / p.bytes, k.work.multiply_adds / (k.work.in_double ? p.in_double : p.single));
}

/// Medians of one stage's runs.
struct Times {
  double wall = 0, kernels = 0, copies = 0;
  cuda::DeviceReport device; ///< of the last run
};

/// Runs fewer times than asked where one takes minutes. peaks: none where there is no card to compare with.
template <class Run>
Times time_stage(const char* stage, const char* mode, int repeats, const std::optional<Peaks>& peaks, Run run) {
  std::vector<double> wall;
  std::vector<std::vector<double>> kernel;
  Timed t;
  for (int i = 0; i < repeats && (wall.empty() || wall.size() * wall.back() < 60); ++i) {
    t = {};
    run(t);
    wall.push_back(t.seconds);
    kernel.resize(std::max(kernel.size(), t.device.kernels.size()));
    for (size_t k = 0; k < t.device.kernels.size(); ++k)
      kernel[k].push_back(t.device.kernels[k].seconds);
  }
  Times times{median(wall), 0, 0, t.device};
  double floor = 0;
  for (size_t k = 0; k < t.device.kernels.size(); ++k) {
    const bool is_copy = t.device.kernels[k].name.rfind("copies", 0) == 0;
    (is_copy ? times.copies : times.kernels) += median(kernel[k]);
    floor += is_copy || !peaks ? 0 : floor_of(t.device.kernels[k], *peaks);
  }
  std::printf("%-8s %-5s %10.4f s", stage, mode, times.wall);
  const auto tell_phases = [&] {
    for (size_t i = 0; i < t.phases.size(); ++i)
      std::printf("%s%s %.4f", i == 0 ? "         phases: " : ", ", t.phases[i].name.c_str(),
                  (i + 1 < t.phases.size() ? t.phases[i + 1].begin : t.seconds) - t.phases[i].begin);
    std::printf(t.phases.empty() ? "" : "\n");
  };
  if (t.device.kernels.empty()) {
    std::printf("\n");
    tell_phases();
    return times;
  }
  std::printf("   kernels %.4f s, ", times.kernels);
  if (peaks)
    std::printf("%.1f times their floor, ", times.kernels / floor);
  std::printf("copies %.4f s, at most %.1f MiB on the device, %zu runs\n", times.copies,
              double(t.device.most_used.own) / 1048576, wall.size());
  tell_phases();
  if (!t.device.note.empty())
    std::printf("         %s\n", t.device.note.c_str());
  for (size_t k = 0; k < t.device.kernels.size(); ++k) {
    const cuda::KernelTime& n = t.device.kernels[k];
    const double s = median(kernel[k]);
    std::printf("    %-28s %6lld launches %11lld items %9.3f ms %9.2f MB", n.name.c_str(),
                static_cast<long long>(n.launches), static_cast<long long>(n.items), 1e3 * s, 1e-6 * n.work.bytes);
    if (peaks)
      std::printf("  %5.1f %% of the bandwidth  %5.1f %% of the multiply-adds",
                  100 * n.work.bytes / s / peaks->bytes,
                  100 * n.work.multiply_adds / s / (n.work.in_double ? peaks->in_double : peaks->single));
    std::printf("\n");
  }
  std::fflush(stdout);
  return times;
}

/// Seconds of a sweep's kernels, and how many points looked for a place.
void tell_sweeps(const Times& t) {
  double seconds = 0;
  int64_t points = 0;
  for (const cuda::KernelTime& k : t.device.kernels) {
    for (const char* name : {"element quality", "points with bad elements", "propose moves", "check moves",
                             "take back", "commit moves", "compact", "scan", "fill"})
      seconds += k.name == name ? k.seconds : 0;
    points += k.name == "propose moves" ? k.items : 0;
  }
  std::printf("         sweeps: %.2f M point updates/s\n", 1e-6 * double(points) / seconds);
}

} // namespace

void time_all(const Hierarchy& h, const density::Options& o, Stage last, int repeats, const How& device,
              const How& reference) {
  const bool on_device = device.by == By::device;
  const char* const name = on_device ? "cuda" : "as it";
  std::optional<Peaks> peaks;
  if (on_device) {
    peaks = measure_peaks();
    std::printf("peaks, measured: %.0f GB/s copied, %.1f T multiply-adds/s in single, %.1f in double precision\n",
                1e-9 * peaks->bytes, 1e-12 * peaks->single, 1e-12 * peaks->in_double);
  }
  BlockGrid grid;
  time_stage("density", name, repeats, peaks, [&](Timed& t) { grid = run_density(h, o, device, t); });
  if (last == Stage::density)
    return;
  TetMesh mesh;
  const auto time_mesh = [&](double adapt) {
    std::printf("--adapt %g\n", adapt);
    contour::Options c;
    c.meshed = contour::Options::both;
    c.adapt = adapt;
    const auto by = [&](const char* mode, const How& how) -> std::optional<Times> {
      try {
        return time_stage("mesh", mode, repeats, peaks, [&](Timed& t) {
          mesh = {}; // large ones do not fit twice
          mesh = run_contour(grid, c, how, t);
        });
      } catch (const std::exception& e) {
        std::printf("mesh     %-5s not made: %s\n", mode, e.what());
        return std::nullopt;
      }
    };
    const std::optional<Times> t = by(name, device); // first: time may be short
    const double tets = 1e-6 * double(mesh.tet.size());
    by("seq", {By::host, 1});
    by("omp", reference);
    if (!t)
      return;
    std::printf(
        "         %zu tetrahedra, %zu points; %d threads of the host; M tetrahedra/s: %.1f by kernels, %.1f "
        "with copies, %.1f in all\n",
        mesh.tet.size(), mesh.point.size(), reference.threads, tets / t->kernels, tets / (t->kernels + t->copies),
        tets / t->wall);
  };
  time_mesh(0);
  time_mesh(contour::default_adapt(grid.frame.spacing));
  if (last != Stage::improve || mesh.tet.empty())
    return;
  tell_sweeps(time_stage("improve", name, repeats, peaks, [&](Timed& t) { run_improve(mesh, grid, device, t); }));
  How alone = reference;
  alone.flow = false;
  time_stage("improve", "omp", repeats, peaks, [&](Timed& t) { run_improve(mesh, grid, alone, t); });
}

} // namespace molmesh::gpu
