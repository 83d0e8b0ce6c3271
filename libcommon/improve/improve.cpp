// improve.cpp — the order of passes: settle on the surface, raise the goal by steps, release the guard at the very
// end.
#include "improve/improve.hpp"
#include "improve/isosurface.hpp"
#include "improve/reference_surface.hpp"
#include "improve/schedule.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <memory>

namespace molmesh::improve {
namespace {

Angles measure(const TetMesh& mesh, int threads) {
  return par::reduce(
      static_cast<int64_t>(mesh.tet.size()), threads, Angles{},
      [&](int64_t t) {
        const Tet& v = mesh.tet[size_t(t)];
        std::array<Vec3d, 4> n;
        for (size_t f = 0; f < 4; ++f) {
          const auto p = [&](int k) { return mesh.point[size_t(v[size_t(outward_face[f][size_t(k)])])]; };
          n[f] = cross(p(1) - p(0), p(2) - p(0));
        }
        Angles a;
        for (size_t i = 0; i < 4; ++i)
          for (size_t j = i + 1; j < 4; ++j) {
            const double angle =
                std::atan2(norm(cross(n[i], n[j])), -dot(n[i], n[j])) * 180 / 3.14159265358979323846;
            a.min = std::min(a.min, angle);
            a.max = std::max(a.max, angle);
          }
        a.below_25 = a.min < 25;
        a.above_140 = a.max > 140;
        return a;
      },
      [](Angles a, const Angles& b) {
        a.min = std::min(a.min, b.min);
        a.max = std::max(a.max, b.max);
        a.below_25 += b.below_25;
        a.above_140 += b.above_140;
        return a;
      });
}

std::vector<uint8_t> curved_triangles(const DynamicMesh& m, const TetMesh& mesh) {
  std::vector<uint8_t> take(mesh.tri.size());
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    for (const Label& l : m.labels)
      if (l.name == mesh.boundary[t] && l.curved())
        take[t] = 1;
  return take;
}

} // namespace

Result improve(TetMesh& mesh, const BlockGrid* density, const Options& options,
               const std::function<void(const std::string&)>& phase) {
  const auto begin = [&](const char* name) {
    if (phase)
      phase(name);
  };
  Result result;
  begin("adjacency");
  DynamicMesh m = build(mesh, density ? 180 : 50, options.threads);
  result.before = result.after = measure(mesh, options.threads);
  if (options.iterations == 0 || mesh.tet.empty())
    return result;

  begin("target");
  std::unique_ptr<Target> target;
  if (density)
    target = std::make_unique<Isosurface>(*density, options.threads);
  else
    target = std::make_unique<ReferenceSurface>(mesh, curved_triangles(m, mesh));
  Schedule schedule(m, target.get(), 32 * target->spacing(), options.threads);

  begin("improve");
  const auto goal_of = [](double low, double high) {
    return static_cast<float>(std::max(angle_quality(low), angle_quality(high)));
  };
  const float goal = goal_of(options.min_dihedral, options.max_dihedral);
  if (density) {
    const float floor = schedule.worst();
    result.counts += schedule.settle(floor, {});
    result.counts += schedule.settle(floor, {});
  }
  static constexpr double share[] = {0.35, 0.6, 0.8, 0.9, 1};
  for (int round = 0; round < options.iterations && schedule.worst() < goal; ++round) {
    const double part = share[std::min<size_t>(size_t(round), std::size(share) - 1)];
    Pass pass;
    pass.goal = static_cast<float>(part * part * goal);
    pass.effort = round >= 2;
    for (int repeat = 0; repeat < 2; ++repeat) {
      result.counts += schedule.run(pass);
      if (density)
        result.counts += schedule.settle(std::min(pass.goal, schedule.worst()), pass.guard);
    }
    ++result.rounds;
  }
  if (result.counts.total() == 0)
    return result; // the file that came in, in its own order
  begin("result");
  TetMesh out = extract(m);
  out.isovalue = mesh.isovalue;
  out.source = mesh.source;
  out.creator = mesh.creator;
  mesh = std::move(out);
  result.after = measure(mesh, options.threads);
  return result;
}

} // namespace molmesh::improve
