// stages.cpp — the stages by either backend or the host itself, and the comparisons of I5.
#include "stages.hpp"
#include "cuda/contour/contour.hpp"
#include "cuda/contour/device_stages.hpp"
#include "cuda/density/density.hpp"
#include "cuda/density/neighboring_search.hpp"
#include "cuda/optimize/geometric_flow.hpp"
#include "cuda/optimize/optimize.hpp"
#include "cuda/par/host.hpp"
#include "mesh/validity.hpp"
#include "unit/density/oracle.hpp"
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>

namespace molmesh::gpu {
namespace {

class Watch {
public:
  explicit Watch(Timed& t) : t_(t) { t_.phases.clear(); }
  ~Watch() { t_.seconds = seconds(); }
  /// What a stage tells of the phases that begin.
  std::function<void(const std::string&)> phases() const {
    return [this](const std::string& name) { t_.phases.push_back({name, seconds()}); };
  }

private:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  Timed& t_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

constexpr int64_t all = std::numeric_limits<int64_t>::max();

cuda::HostBackend host_backend(const How& how, int64_t paged) {
  return cuda::HostBackend(how.threads, {how.most_bytes > 0 ? how.most_bytes : all, paged});
}

} // namespace

BlockGrid run_density(const Hierarchy& h, const density::Options& o, const How& how, Timed& time) {
  density::Counts counts;
  Band band;
  {
    const Watch watch(time);
    if (how.by == By::device) {
      band = cuda::compute_density(h, o, counts, time.device, how.most_bytes);
    } else {
      cuda::HostBackend backend = host_backend(how, 0);
      band = density::compute(
          h, o, counts,
          [&](const density::Field& f, const GridFrame& frame, const density::SearchOptions& s,
              density::SearchCounts& c) { return cuda::Search<cuda::HostBackend>(backend, f, frame, s).run(c); });
      time.device = cuda::report_of(backend, "the host");
    }
  }
  return to_block_grid(band, how.threads);
}

TetMesh run_contour(const BlockGrid& grid, const contour::Options& o, const How& how, Timed& time) {
  contour::Summary summary;
  contour::Options options = o;
  options.threads = how.threads;
  const Watch watch(time);
  const auto phase = watch.phases();
  if (how.by == By::host)
    return contour::contour(grid, options, summary, phase);
  if (how.by == By::device)
    return cuda::contour_mesh(grid, options, summary, phase, time.device, how.most_bytes);
  cuda::HostBackend backend = host_backend(how, all);
  TetMesh mesh;
  {
    cuda::DeviceStages<cuda::HostBackend> stages(backend, how.threads);
    mesh = contour::contour(grid, options, summary, phase, stages);
  }
  time.device = cuda::report_of(backend, "the host");
  return mesh;
}

TetMesh run_improve(const TetMesh& mesh, const BlockGrid& grid, const How& how, Timed& time) {
  TetMesh out = mesh;
  optimize::Options options;
  options.threads = how.threads;
  const Watch watch(time);
  const auto phase = watch.phases();
  if (how.by == By::device) {
    cuda::improve_mesh(out, &grid, options, phase, time.device, how.most_bytes);
    return out;
  }
  if (!how.flow) {
    optimize::improve(out, &grid, options, phase);
    return out;
  }
  cuda::HostBackend backend = host_backend(how, all);
  std::unique_ptr<cuda::Flow<cuda::HostBackend>> flow;
  optimize::improve(out, &grid, options, phase,
                    [&](optimize::DynamicMesh& m, const Isosurface* surface, const optimize::Pass& pass) {
                      if (!flow)
                        flow = std::make_unique<cuda::Flow<cuda::HostBackend>>(backend, surface, how.threads);
                      return flow->run(m, pass, cuda::flow_sweeps);
                    });
  time.device = cuda::report_of(backend, "the host");
  return out;
}

std::string compare_grids(const Hierarchy& h, const BlockGrid& device, const BlockGrid& host) {
  if (!(device.frame.points == host.frame.points))
    return "the frames differ";
  const BlockIndex in_device(device), in_host(host);
  const double eps = host.info.tolerance;
  int64_t active = 0, differ = 0, value = 0, side = 0;
  for (size_t b = 0; b < host.corner.size(); ++b)
    for (int s = 0; s < 512; ++s) {
      const Vec3i p = host.corner[b] + within_block(s);
      const bool here = is_active(host, in_host, p), there = is_active(device, in_device, p);
      const float v = value_at(host, in_host, p), w = value_at(device, in_device, p);
      active += here;
      differ += here != there;
      value += here && there && std::abs(v - w) > 2 * eps * std::max(1.f, v);
      side += !here && !there && v != w;
    }
  int64_t wrong = 0;
  std::mt19937 random(3);
  const int samples = h.atom.size() < 5000 ? 500 : 50;
  for (int n = 0; n < samples && !device.corner.empty();) {
    const size_t b = random() % device.corner.size();
    const int s = static_cast<int>(random() % 512);
    if (!(device.active[8 * b + static_cast<size_t>(s >> 6)] >> (s & 63) & 1))
      continue;
    const Vec3i p = device.corner[b] + within_block(s);
    const double exact = test::exact_density(h, device.info.decay, device.frame.position(p));
    wrong += !(std::abs(device.value[512 * b + static_cast<size_t>(s)] - exact) <= eps * std::max(1.0, exact));
    ++n;
  }
  if (value + side + wrong > 0 || differ * 1000 > active || active == 0)
    return std::to_string(active) + " active points: " + std::to_string(differ) + " active in one only, " +
           std::to_string(value) + " with other values, " + std::to_string(side) + " on other sides, " +
           std::to_string(wrong) + " of " + std::to_string(samples) + " samples beyond the tolerance";
  return {};
}

std::string compare_meshes(const TetMesh& device, const TetMesh& host, double tolerance) {
  if (device.tet != host.tet || device.tri != host.tri || device.region != host.region ||
      device.boundary != host.boundary)
    return "the connectivity differs: " + std::to_string(device.tet.size()) + " tetrahedra and " +
           std::to_string(host.tet.size());
  double worst = 0;
  for (size_t i = 0; i < host.point.size(); ++i)
    worst = std::max(worst, norm(device.point[i] - host.point[i]));
  return worst <= tolerance ? "" : "a point lies " + std::to_string(worst) + " Å away";
}

std::string check_valid(const TetMesh& mesh) {
  const Validity v = check_validity(mesh, 1);
  return v.valid() ? "" : v.faults[0].rule + ": " + v.faults[0].example;
}

} // namespace molmesh::gpu
