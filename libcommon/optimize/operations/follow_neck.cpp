// follow_neck.cpp — the surface follows the target down where that is narrower than the grid.
// The surface is a tube there: a ring of its edges crosses the plane at the narrowest place. The elements at these
// edges shrink towards that place, in shells (local_scaling.hpp), and the tube runs into it from either side as a
// cone does. What its points are off then is small beside the elements they belong to.
#include "optimize/acceptance/surface_fit.hpp"
#include "optimize/operations/local_scaling.hpp"
#include "optimize/operations/operations.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::optimize {
namespace {

// The ring of surface edges across the neck's plane that comes nearest to the neck, of the surface near v: the
// elements at them.
bool find_ring(Region& r, int32_t v, const Neck& neck, Core& core) {
  std::vector<int32_t>& star = r.work.star;
  Ring& ring = r.work.ring;
  constexpr size_t most_reached = 100, longest = 24;
  const double far = 3 * r.target->spacing();
  const auto ahead = [&](int32_t w) { return dot(r.mesh.point[w] - neck.at, neck.along); };
  const auto crosses = [&](int32_t w, int32_t u) { return (ahead(w) > 0) != (ahead(u) > 0); };
  int32_t t = -1, a = -1, b = -1;
  double nearest = far;
  std::vector<int32_t> reached{v};
  for (size_t i = 0; i < reached.size() && reached.size() < most_reached; ++i) {
    const int32_t w = reached[i];
    if (!r.on_main_target(w) || !r.star(w, star))
      continue;
    for (const int32_t k : star) {
      const Element& e = r.mesh.element[k];
      for (size_t f = 0; f < 4; ++f)
        for (size_t g = 0; g < 4; ++g) {
          const int32_t u = e.v[g];
          if (e.label[f] == 0 || e.v[f] == w || g == f || u == w)
            continue;
          const Vec3d from = r.mesh.point[w], to = r.mesh.point[u];
          if (norm(to - neck.at) < far && std::find(reached.begin(), reached.end(), u) == reached.end())
            reached.push_back(u);
          if (!crosses(w, u))
            continue;
          const double x = ahead(w), distance = norm(from + x / (x - ahead(u)) * (to - from) - neck.at);
          if (distance < nearest)
            nearest = distance, t = k, a = w, b = u;
        }
    }
  }
  if (t < 0)
    return false;
  const std::pair<int32_t, int32_t> first = std::minmax(a, b);
  int32_t left = -1;
  for (size_t steps = 0; steps < longest; ++steps) {
    if (!r.ring(t, a, b, ring) || ring.border.size() != 2)
      return false;
    core.element.insert(core.element.end(), ring.element.begin(), ring.element.end());
    const bool back = ring.vertex[ring.border[0]] == left;
    const auto at = static_cast<size_t>(ring.border[back ? 1 : 0]);
    const int32_t w = ring.vertex[at]; // of the next triangle
    t = ring.element[std::min(at, ring.element.size() - 1)];
    left = std::exchange(crosses(w, a) ? b : a, w);
    if (std::pair<int32_t, int32_t>(std::minmax(a, b)) == first) {
      par::sort_unique(core.element, 1);
      return true;
    }
  }
  return false;
}

} // namespace

bool find_neck(const Region& r, int32_t v, Neck& neck) {
  return r.on_main_target(v) && r.target && r.target->neck(r.mesh.point[v], neck);
}

bool follow_neck(Region& r, int32_t v, const Neck& neck, double ratio) {
  Core core;
  core.through = true;
  if (!r.target || !find_ring(r, v, neck, core) || !find_shell(r, core, neck.at))
    return false;
  for (const int32_t t : core.element) {
    const Element& e = r.mesh.element[t];
    for (size_t f = 0; f < 4; ++f)
      if (e.label[f] != 0)
        for (const int32_t w : outward_triangle(e.v, f))
          core.vertex.push_back(w);
  }
  par::sort_unique(core.vertex, 1);
  double scale = 1, least = 1e30;
  for (double s = 0.9; s > 0.005 && least > 0.8; s *= 0.9) {
    double most = 0;
    for (const int32_t w : core.vertex)
      most = std::max(most, off_at(r, r.mesh.vertex[w], neck.at + s * (r.mesh.point[w] - neck.at)).value_or(1e30));
    if (most < least)
      least = most, scale = s;
  }
  return scale < 0.9 && shrink(r, core, neck.at, scale, ratio);
}

} // namespace molmesh::optimize
