// surface_retreat.cpp — lets a vertex off the target leave the surface: elements on its wrong side change sides.
#include "optimize/operations/moving_vertex.hpp"
#include <algorithm>

namespace molmesh::optimize {
namespace {

/// What goes to the other side.
struct Side {
  std::vector<int32_t> element;
  int32_t to = -1, fresh = -1; ///< region they come to; vertex that is new on the surface, or -1
  uint8_t label = 0;
  bool grows = false; ///< the inside does
  Fit before;         ///< of the triangles at the vertex
};

// What goes with v: the elements on its wrong side. The shell they show to the others becomes the surface; it may
// hold one inner vertex, which is new on the surface. False where the surface would touch itself. Needs the star.
bool find_side(const Region& r, const Acceptance& accept, int32_t v, Side& side) {
  const std::vector<int32_t>& star = r.work.star;
  double distance;
  Vec3d normal;
  if (!r.target->probe(r.mesh.point[v], distance, normal))
    return false;
  int32_t inside = -1, outside = -1;
  std::vector<int32_t> around; // the vertices across v's triangles
  for (const int32_t t : star) {
    const Element& e = r.mesh.element[t];
    for (size_t f = 0; f < 4; ++f) {
      if (e.label[f] == 0 || e.v[f] == v)
        continue;
      if (e.n[f] < 0)
        return false;
      (r.mesh.outward(e, f) ? inside : outside) = e.region;
      side.label = e.label[f];
      for (const int32_t w : e.v)
        around.push_back(w == v || w == e.v[f] ? -1 : w);
      if (r.mesh.outward(e, f))
        side.before.add(misfit_of(r, accept, e, f));
    }
  }
  side.grows = distance < 0;
  side.to = side.grows ? inside : outside;
  const auto is_around = [&](int32_t w) { return std::find(around.begin(), around.end(), w) != around.end(); };
  for (const int32_t t : star) {
    const Element& e = r.mesh.element[t];
    if (e.region == side.to)
      continue;
    const int k = e.find(v);
    if (inside < 0 || outside < 0 || (e.region != inside && e.region != outside) || e.label[k] != 0)
      return false;
    side.element.push_back(t);
    for (const int32_t w : e.v)
      if (w != v && w != side.fresh && !is_around(w)) {
        if (side.fresh >= 0 || r.mesh.vertex[w].kind != Kind::interior)
          return false;
        side.fresh = w;
      }
    Ring ring;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        if (i != k && j != k && is_around(e.v[i]) && is_around(e.v[j]) && e.label[6 - i - j - k] == 0 &&
            (!r.ring(t, e.v[i], e.v[j], ring) || !ring.border.empty()))
          return false; // an edge of the shell that is on the surface already
  }
  return !side.element.empty();
}

} // namespace

bool retreat_surface(Region& r, const Acceptance& accept, int32_t v) {
  auto& [star, other_star, old, now, ring, elements, triangles] = r.work;
  Side side;
  if (r.mesh.vertex[v].kind != Kind::surface || !r.target || !r.star(v, star) || !find_side(r, accept, v, side))
    return false;
  side.before.excess += std::max(0., off(r, v) - 1);
  const int32_t u = side.fresh;
  const Vec3d home = u < 0 ? Vec3d{} : r.mesh.point[u];
  const auto back = [&] {
    if (u >= 0)
      r.mesh.point[u] = home;
    return false;
  };
  now.clear();
  if (u >= 0) {
    if (!r.star(u, other_star))
      return false;
    const float above = accept.demand(r.worst(other_star));
    double length = 0;
    for (const int32_t t : other_star)
      for (const int32_t w : r.mesh.element[t].v)
        length += norm(r.mesh.point[w] - home) / (3. * double(other_star.size()));
    if (!r.target->project(r.mesh.point[u], length) || !r.inside_walls(home, r.mesh.point[u]))
      return back();
    for (const int32_t t : other_star) {
      now.push_back({r.mesh.element[t].v, 0, 0, {}});
      if (!r.judge(now.back(), above))
        return back();
    }
  }
  Fit after;
  for (const int32_t t : side.element) {
    const Element& e = r.mesh.element[t];
    const auto s = outward_triangle(e.v, size_t(e.find(v)));
    const auto p = [&](size_t i) { return r.mesh.point[s[i]]; };
    after.add(side.grows ? misfit_of(r, accept, p(0), p(1), p(2)) : misfit_of(r, accept, p(0), p(2), p(1)));
  }
  if (!accept.fits(after, side.before))
    return back();
  for (size_t i = 0; i < now.size(); ++i) {
    r.mesh.element[other_star[i]].q = now[i].q;
    r.note_change(other_star[i]);
  }
  for (const int32_t t : side.element) {
    Element& e = r.mesh.element[t];
    e.region = side.to;
    for (size_t f = 0; f < 4; ++f) {
      Element& beyond = r.mesh.element[e.n[f]];
      r.note_side(e.n[f], beyond.face_towards(t));
      if (e.v[f] == v)
        r.mesh.note_label(t), r.mesh.note_label(e.n[f]);
      for (size_t g = 0; g < 4; ++g)
        if (beyond.n[g] == t)
          beyond.label[g] = e.label[f] = e.v[f] == v ? side.label : uint8_t{0};
    }
  }
  r.mesh.vertex[v] = {};
  if (u >= 0)
    r.mesh.vertex[u] = {Kind::surface, 0, side.label};
  r.changed.insert(r.changed.end(), star.begin(), star.end());
  if (u >= 0)
    r.changed.insert(r.changed.end(), other_star.begin(), other_star.end());
  for (const auto* list : {&star, &other_star})
    for (const int32_t t : *list)
      if (list == &star || u >= 0) {
        r.log.add(t);
        r.touch(t);
      }
  return r.done(&Counts::retreats, "surface retreat");
}

} // namespace molmesh::optimize
