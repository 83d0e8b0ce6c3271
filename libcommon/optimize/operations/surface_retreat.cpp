// surface_retreat.cpp — a surface vertex that finds no place on the target leaves the surface: the elements on its
// wrong side change sides.
#include "optimize/operations/editor.hpp"
#include <algorithm>

namespace molmesh::optimize {

// What goes with v: the elements on its wrong side. The shell they show to the others becomes the surface; it may
// hold one inner vertex, which is new on the surface. False where the surface would touch itself. Needs star_.
bool Editor::find_side(int32_t v, Side& side) const {
  double distance;
  Vec3d normal;
  if (!target_->probe(m_.point[v], distance, normal))
    return false;
  int32_t inside = -1, outside = -1;
  std::vector<int32_t> rim;
  for (const int32_t t : star_) {
    const Element& e = m_.element[t];
    for (size_t f = 0; f < 4; ++f) {
      if (e.label[f] == 0 || e.v[f] == v)
        continue;
      if (e.n[f] < 0)
        return false;
      (m_.outward(e, f) ? inside : outside) = e.region;
      side.label = e.label[f];
      for (const int32_t w : e.v)
        rim.push_back(w == v || w == e.v[f] ? -1 : w);
      if (m_.outward(e, f))
        side.before.add(misfit_face(e, f));
    }
  }
  side.grows = distance < 0;
  side.to = side.grows ? inside : outside;
  const auto on_rim = [&](int32_t w) { return std::find(rim.begin(), rim.end(), w) != rim.end(); };
  for (const int32_t t : star_) {
    const Element& e = m_.element[t];
    if (e.region == side.to)
      continue;
    const int k = e.find(v);
    if (inside < 0 || outside < 0 || (e.region != inside && e.region != outside) || e.label[k] != 0)
      return false;
    side.element.push_back(t);
    for (const int32_t w : e.v)
      if (w != v && w != side.fresh && !on_rim(w)) {
        if (side.fresh >= 0 || m_.vertex[w].kind != Kind::interior)
          return false;
        side.fresh = w;
      }
    Ring around;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        if (i != k && j != k && on_rim(e.v[i]) && on_rim(e.v[j]) && e.label[6 - i - j - k] == 0 &&
            (!ring(t, e.v[i], e.v[j], around) || !around.border.empty()))
          return false; // an edge of the shell that is on the surface already
  }
  return !side.element.empty();
}

bool Editor::hand_over(int32_t v) {
  Side side;
  if (m_.vertex[v].kind != Kind::surface || !target_ || !star(v, star_) || !find_side(v, side))
    return false;
  side.before.excess += std::max(0., off(v) - 1);
  const int32_t u = side.fresh;
  const Vec3d home = u < 0 ? Vec3d{} : m_.point[u];
  const auto back = [&] {
    if (u >= 0)
      m_.point[u] = home;
    return false;
  };
  now_.clear();
  if (u >= 0) {
    if (!star(u, star2_))
      return false;
    const float above = demand(worst(star2_));
    double length = 0;
    for (const int32_t t : star2_)
      for (const int32_t w : m_.element[t].v)
        length += norm(m_.point[w] - home) / (3. * double(star2_.size()));
    if (!target_->project(m_.point[u], length) || !inside_walls(home, m_.point[u]))
      return back();
    for (const int32_t t : star2_) {
      now_.push_back({m_.element[t].v, 0, 0, {}});
      if (!judge(now_.back(), above))
        return back();
    }
  }
  Fit after;
  for (const int32_t t : side.element) {
    const Element& e = m_.element[t];
    const auto s = outward_triangle(e.v, size_t(e.find(v)));
    const auto p = [&](size_t i) { return m_.point[s[i]]; };
    after.add(side.grows ? misfit(p(0), p(1), p(2)) : misfit(p(0), p(2), p(1)));
  }
  if (!fits(after, side.before))
    return back();
  for (size_t i = 0; i < now_.size(); ++i) {
    m_.element[star2_[i]].q = now_[i].q;
    note_change(star2_[i]);
  }
  for (const int32_t t : side.element) {
    Element& e = m_.element[t];
    e.region = side.to;
    for (size_t f = 0; f < 4; ++f) {
      Element& beyond = m_.element[e.n[f]];
      note_side(e.n[f], beyond.face_towards(t));
      if (e.v[f] == v)
        m_.note_label(t), m_.note_label(e.n[f]);
      for (size_t g = 0; g < 4; ++g)
        if (beyond.n[g] == t)
          beyond.label[g] = e.label[f] = e.v[f] == v ? side.label : uint8_t{0};
    }
  }
  m_.vertex[v] = {};
  if (u >= 0)
    m_.vertex[u] = {Kind::surface, 0, side.label};
  changed.insert(changed.end(), star_.begin(), star_.end());
  if (u >= 0)
    changed.insert(changed.end(), star2_.begin(), star2_.end());
  for (const auto* list : {&star_, &star2_})
    for (const int32_t t : *list)
      if (list == &star_ || u >= 0) {
        log.add(t);
        touch(t);
      }
  ++counts.hand_overs;
  return true;
}

} // namespace molmesh::optimize
