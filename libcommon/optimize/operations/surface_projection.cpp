// surface_projection.cpp — surface vertices of a part move onto the target.
#include "optimize/operations/moving_vertex.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {
namespace {

void project_vertex(Region& r, const Acceptance& accept, int32_t v, float floor, Moves* later) {
  if (!r.star(v, r.work.star))
    return;
  Vec3d to = r.mesh.point[v];
  if (!project(r, r.mesh.vertex[v], to, accept.guard.reach * mean_edge(r, r.work.star, v)))
    return;
  const float now = r.worst(r.work.star), above = floor >= 1 ? 0.5f * now : std::min(floor, now) * 0.999999f;
  step_towards(r, accept, v, to, 0.5, 0.1, above, later);
}

// Whether one of the targets of a vertex between domains is known, and farther than that.
bool is_away(const Region& r, int32_t v, double there) {
  const Vertex& vertex = r.mesh.vertex[v];
  double distance;
  Vec3d normal;
  for (int k = 0; k < (vertex.kind == Kind::line ? 2 : 1); ++k)
    if (r.target_of(k == 0 ? vertex.label : vertex.second)->probe(r.mesh.point[v], distance, normal) &&
        std::abs(distance) >= there)
      return true;
  return false;
}

// Those that are not there yet: a vertex stays where it is until its turn.
void project_each_vertex(Region& r, const Acceptance& accept, const std::vector<int32_t>& vertices, float floor,
                         Moves* later) {
  const double there = 2e-3 * r.spacing();
  for (size_t first = 0; first < vertices.size(); first += 8) {
    const size_t n = std::min<size_t>(8, vertices.size() - first);
    const EightProbes probes = probe_some(*r.target, r.mesh.point, vertices.data() + first, n);
    for (size_t i = 0; i < n; ++i)
      if (has_main_target(r.mesh, vertices[first + i]) ? probes.is_known(i) && std::abs(probes.distance[i]) >= there
                                                       : is_away(r, vertices[first + i], there))
        project_vertex(r, accept, vertices[first + i], floor, later);
  }
}

} // namespace

void project_to_surface(Region& r, const Acceptance& accept, const std::vector<int32_t>& vertices, float floor) {
  if (!r.target)
    return;
  const Counts before = r.counts;
  Moves moved;
  project_each_vertex(r, accept, vertices, floor, r.crossings.on() ? &moved : nullptr);
  if (!r.crossings.on() || !r.crossings.any_crosses(moved.face))
    return;
  for (auto i = moved.vertex.rbegin(); i != moved.vertex.rend(); ++i)
    r.mesh.point[i->first] = i->second;
  for (auto i = moved.element.rbegin(); i != moved.element.rend(); ++i)
    r.mesh.element[i->first].q = i->second;
  r.changed.clear();
  r.counts = before;
  project_each_vertex(r, accept, vertices, floor, nullptr);
}

} // namespace molmesh::optimize
