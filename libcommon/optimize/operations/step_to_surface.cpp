// step_to_surface.cpp — a vertex on its way to the target: a step that leaves its elements room to be mended.
#include "optimize/operations/editor.hpp"
#include <algorithm>

namespace molmesh::optimize {

bool Editor::approach(int32_t v, float floor) {
  const Vertex& vertex = m_.vertex[v];
  if (!follows_target(vertex.kind) || !target_ || !star(v, star_))
    return false;
  const Vec3d from = m_.point[v];
  const double length = mean_edge(star_, v), furthest = 1.5 * length;
  Vec3d to;
  double nearest = furthest;
  for (int k = 0; k < 27; ++k) {
    const Vec3d d{k / 9 - 1., k / 3 % 3 - 1., k % 3 - 1.};
    for (double r = 0.05; r < 1.5; r *= 1.5) {
      Vec3d y = from + r * length / std::max(norm(d), 1.) * d;
      if (put_on_target(vertex, from, y, length) && norm(y - from) < nearest)
        nearest = norm(y - from), to = y;
    }
  }
  if (!(nearest < furthest))
    return false;
  const float above = std::min(floor, worst(star_)) * 0.999999f;
  return step_to(v, to, 0.7, 0.05, above);
}

} // namespace molmesh::optimize
