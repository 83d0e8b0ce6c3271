// step_to_surface.cpp — a vertex on its way to the target: a step that leaves its elements room to be repaired.
#include "optimize/operations/moving_vertex.hpp"
#include <algorithm>

namespace molmesh::optimize {

bool step_to_surface(Region& r, const Acceptance& accept, int32_t v, float floor) {
  const Vertex& vertex = r.mesh.vertex[v];
  if (!follows_target(vertex.kind) || !r.target || !r.star(v, r.work.star))
    return false;
  const Vec3d from = r.mesh.point[v];
  const double length = mean_edge(r, r.work.star, v), furthest = 1.5 * length;
  const OnTarget on_target{r, vertex, from, length};
  Vec3d to;
  double nearest = furthest;
  for (int k = 0; k < 27; ++k) {
    const Vec3d d{k / 9 - 1., k / 3 % 3 - 1., k % 3 - 1.};
    for (double step = 0.05; step < 1.5; step *= 1.5) {
      Vec3d y = from + step * length / std::max(norm(d), 1.) * d;
      if (on_target(y) && norm(y - from) < nearest)
        nearest = norm(y - from), to = y;
    }
  }
  if (!(nearest < furthest))
    return false;
  const float above = std::min(floor, r.worst(r.work.star)) * 0.999999f;
  return step_towards(r, accept, v, to, 0.7, 0.05, above);
}

} // namespace molmesh::optimize
