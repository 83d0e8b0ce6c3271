// shrink_cavity.cpp — shrinks a closed surface smaller than the grid to the target's size and place.
#include "optimize/acceptance/surface_fit.hpp"
#include "optimize/operations/local_scaling.hpp"
#include "optimize/operations/operations.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {
namespace {

constexpr size_t most_vertices = 24; // of the surface, which else has room

// The closed surface that v is on and the elements at it. False where it is large or not all of this part.
bool find_core(Region& r, int32_t v, Core& core) {
  std::vector<int32_t>& star = r.work.star;
  core.vertex.push_back(v);
  for (size_t i = 0; i < core.vertex.size(); ++i) {
    const int32_t w = core.vertex[i];
    if (core.vertex.size() > most_vertices || !r.on_main_target(w) || !r.star(w, star))
      return false;
    core.element.insert(core.element.end(), star.begin(), star.end());
    for (const int32_t t : star) {
      const Element& e = r.mesh.element[t];
      for (size_t f = 0; f < 4; ++f)
        for (size_t k = 0; k < 4; ++k)
          if (e.label[f] != 0 && e.v[f] != w && k != f && !core.has(e.v[k]))
            core.vertex.push_back(e.v[k]);
    }
  }
  par::sort_unique(core.element, 1);
  double volume = 0; // six times, negative where the molecule is around it
  const Vec3d home = r.mesh.point[v];
  for (const int32_t w : core.vertex)
    core.centre += r.mesh.point[w] / double(core.vertex.size());
  for (const int32_t t : core.element) {
    const Element& e = r.mesh.element[t];
    for (size_t f = 0; f < 4; ++f)
      if (const auto s = outward_triangle(e.v, f); core.has(s) && r.mesh.counts_here(e, f)) {
        const auto p = [&](size_t k) { return r.mesh.point[s[k]] - home; };
        volume += (r.mesh.outward(e, f) ? 1 : -1) * dot(p(0), cross(p(1), p(2)));
      }
  }
  core.hole = volume < 0;
  return true;
}

// How small it has to be, and where, to lie on the target around `to`: as large as it may.
bool fit_core(const Region& r, const Core& core, Vec3d& to, double& scale) {
  const double h = r.target->spacing();
  const auto most_off = [&](Vec3d at, double s) {
    double most = 0;
    for (const int32_t w : core.vertex)
      most = std::max(most, off_at(r, r.mesh.vertex[w], at + s * (r.mesh.point[w] - core.centre)).value_or(1e30));
    return most;
  };
  double best = 1e30;
  const Vec3d from = to;
  for (double s = 1; s > 0.005 && best > 0.8; s *= 0.9) {
    Vec3d x = from;
    double now = most_off(x, s);
    for (double step = 0.2 * h; step > 1e-3 * h; step *= 0.5)
      for (bool again = true; again;) {
        again = false;
        for (int d = 0; d < 6; ++d) {
          Vec3d y = x;
          y[d / 2] += d % 2 ? step : -step;
          if (const double off = most_off(y, s); off < 0.99 * now)
            now = off, x = y, again = true;
        }
      }
    if (now < best)
      best = now, to = x, scale = s;
  }
  return scale < 0.9;
}

} // namespace

bool shrink_cavity(Region& r, int32_t v, double ratio) {
  Core core;
  if (!r.target || !find_core(r, v, core))
    return false;
  Vec3d to = core.centre;
  double scale = 1;
  if (!r.target->pocket(core.centre, core.hole, to) || !fit_core(r, core, to, scale))
    return false;
  const Vec3d c = core.centre + (to - core.centre) / (1 - scale);
  return find_shell(r, core, c) && shrink(r, core, c, scale, ratio);
}

} // namespace molmesh::optimize
