// moves.cpp — vertices move or come: search for the worst element, settling on the target, edge splits.
#include "improve/editor.hpp"
#include <algorithm>

namespace molmesh::improve {
namespace {

// Directions a vertex may take: all, the free axes, or the plane across the normal.
int basis_of(const Vertex& k, const Target* target, bool lifted, Vec3d x, Vec3d basis[3]) {
  int n = 0;
  if (k.kind == Kind::fixed)
    return 0;
  if (k.kind != Kind::surface || (lifted && target)) {
    for (int a = 0; a < 3; ++a)
      if (!(k.frozen >> a & 1))
        basis[n] = {}, basis[n++][a] = 1;
    return n;
  }
  double distance;
  Vec3d normal;
  if (!target || !target->probe(x, distance, normal))
    return 0;
  Vec3d other{1, 0, 0};
  if (std::abs(normal.x) > 0.6)
    other = {0, 1, 0};
  basis[0] = cross(normal, other);
  basis[0] = basis[0] / norm(basis[0]);
  basis[1] = cross(normal, basis[0]);
  return 2;
}

} // namespace

// Of the sails with the vertex at x, where no element is as bad as `above`: what a search raises to make the
// surface fit.
float Editor::worth(Vec3d x, float above) {
  return spokes_.worst(x, above) > above ? fit_of_sails(x).worth() : 0;
}

bool Editor::search(const Vertex& k, Vec3d& x, float& best, float aim, double length, const Fit& before,
                    float above) {
  Vec3d basis[3];
  const int dimensions = basis_of(k, target_, guard_.lift > 0, x, basis);
  if (dimensions == 0)
    return false;
  const Vec3d from = x;
  const auto bind = [&](Vec3d& y) { return constrain(k, from, y, guard_.reach * length); };
  if (straighten) {
    struct {
      Editor& editor;
      float above;
      float worst(Vec3d y, float) { return editor.worth(y, above); }
      Vec3d ascent(Vec3d, double) { return {}; }
    } straightness{*this, above};
    return pattern_search(straightness, x, best, 1, length, basis, dimensions, bind, [](Vec3d) { return true; });
  }
  return pattern_search(spokes_, x, best, aim, length, basis, dimensions, bind,
                        [&](Vec3d y) { return sails_fit(y, before); });
}

// Spokes and sails of v's star; the mean length of its edges, and how it fits now.
void Editor::gather(const std::vector<int32_t>& elements, int32_t v, double& length, Fit& before) {
  const Vec3d from = m_.point[size_t(v)];
  spokes_.clear(from);
  sails_.clear();
  length = 0;
  for (const int32_t t : elements) {
    const Element& e = m_.element[size_t(t)];
    const int i = e.find(v);
    std::array<Vec3d, 4> p;
    for (size_t j = 0; j < 4; ++j) {
      p[j] = m_.point[size_t(e.v[j])];
      length += norm(p[j] - from);
    }
    spokes_.add(p, i);
    if (m_.vertex[size_t(v)].kind == Kind::surface)
      for (size_t f = 0; f < 4; ++f)
        if (e.label[f] != 0 && f != size_t(i))
          add_sail(e, f, v);
  }
  length /= 3. * double(elements.size());
  before = fit_of_sails();
  if (straighten)
    before.excess += std::max(0., off(v) - 1);
}

// v is at its new place: takes it when every element of the star is above.
bool Editor::take(const std::vector<int32_t>& elements, int32_t v, Vec3d from, float above, float allowed) {
  now_.clear();
  for (const int32_t t : elements) {
    const Element& e = m_.element[size_t(t)];
    now_.push_back({e.v, e.region, 0, {}});
    if (!judge(now_.back(), above)) {
      m_.point[size_t(v)] = from;
      return false;
    }
  }
  rim_.clear();
  rim_face_.clear();
  if (sheets_ && m_.vertex[size_t(v)].kind == Kind::surface)
    list_rim(elements, v, -1);
  if (lack(now_) > allowed || rim_crosses(false)) {
    m_.point[size_t(v)] = from;
    return false;
  }
  move_rim();
  for (size_t i = 0; i < elements.size(); ++i) {
    Element& e = m_.element[size_t(elements[i])];
    e.q = now_[i].q;
    for (const int32_t w : e.v)
      m_.touched[size_t(w)] = time;
  }
  changed.insert(changed.end(), elements.begin(), elements.end());
  ++counts.moves;
  return true;
}

bool Editor::smooth(int32_t v) {
  const Vertex& k = m_.vertex[size_t(v)];
  if (k.kind == Kind::fixed || !star(v, star_))
    return false;
  const float before = worst(star_), above = straighten ? demand(before) : before;
  if (!straighten && before >= goal)
    return false;
  double length;
  Fit fit;
  gather(star_, v, length, fit);
  if (straighten && fit.excess == 0)
    return false;
  const Vec3d from = m_.point[size_t(v)];
  Vec3d x = from;
  float best = straighten ? fit.worth() : before;
  if (!search(k, x, best, goal, length, fit, above))
    return false;
  m_.point[size_t(v)] = x;
  return take(star_, v, from, above, lack(star_));
}

bool Editor::settle(int32_t v, float floor) {
  if (m_.vertex[size_t(v)].kind != Kind::surface || !target_)
    return false;
  const Vec3d from = m_.point[size_t(v)];
  double distance;
  Vec3d normal;
  if (!target_->probe(from, distance, normal) || std::abs(distance) < 2e-3 * target_->spacing())
    return false;
  if (!star(v, star_))
    return false;
  double length;
  Fit fit;
  gather(star_, v, length, fit);
  Vec3d to = from;
  if (!target_->project(to, guard_.reach * length))
    return false;
  const float now = worst(star_), above = floor >= 1 ? 0.5f * now : std::min(floor, now) * 0.999999f;
  for (double step = 1; step > 0.1; step *= 0.5) {
    m_.point[size_t(v)] = step == 1 ? to : from + step * (to - from);
    if (take(star_, v, from, above, 1e30f))
      return true;
  }
  return false;
}

bool Editor::split(int32_t e, int i, int j) {
  const int32_t a = m_.element[size_t(e)].v[size_t(i)], b = m_.element[size_t(e)].v[size_t(j)];
  if (room_.vertex.empty() || !ring(e, a, b, ring_) || !has_room(ring_.element.size(), 2 * ring_.element.size()))
    return false;
  if (target_ && norm(m_.point[size_t(a)] - m_.point[size_t(b)]) < 0.3 * target_->spacing())
    return false;
  Vertex kind;
  if (!ring_.border.empty()) {
    if (ring_.border.size() != 2 || ring_.label[0] != ring_.label[1])
      return false;
    const Label& label = m_.labels[ring_.label[0]];
    kind.label = ring_.label[0];
    kind.crowded = m_.vertex[size_t(a)].crowded || m_.vertex[size_t(b)].crowded;
    kind.kind = label.curved() ? Kind::surface : Kind::sliding;
    if (!label.curved())
      kind.frozen = static_cast<uint8_t>(1 << label.axis);
    if (label.curved() && !target_)
      return false;
  }
  const float before = worst(ring_.element), aim = before + 1e-8f + 0.02f * before;
  const float above = straighten ? demand(before) : before;
  now_.clear();
  spokes_.clear(0.5 * (m_.point[size_t(a)] + m_.point[size_t(b)]));
  sails_.clear();
  const int32_t v = room_.vertex.back(), ends[2] = {a, b};
  for (const int32_t t : ring_.element) {
    const Element& el = m_.element[size_t(t)];
    for (const int32_t end : ends) {
      Candidate c{el.v, el.region, 0, {}};
      const int k = el.find(end);
      std::array<Vec3d, 4> p;
      for (size_t n = 0; n < 4; ++n)
        p[n] = m_.point[size_t(c.v[n])];
      c.v[size_t(k)] = v;
      spokes_.add(p, k);
      now_.push_back(c);
      for (size_t f = 0; f < 4; ++f)
        if (el.label[f] != 0 && el.v[f] != a && el.v[f] != b)
          add_sail(el, f, end);
    }
  }
  Fit fit = fit_of_sails();
  fit.excess /= 2; // each triangle goes with either end
  const Vec3d pa = m_.point[size_t(a)], pb = m_.point[size_t(b)];
  const double length = norm(pb - pa);
  Vec3d x = 0.5 * (pa + pb);
  if (!constrain(kind, x, x, guard_.reach * length) || (!straighten && !sails_fit(x, fit)))
    return false;
  float best = spokes_.worst(x, 0.25f * before);
  if (!(best > 0.25f * before))
    return false; // too far from a gain to search for it
  if (straighten)
    best = worth(x, above);
  search(kind, x, best, std::max(goal, aim), length, fit, above);
  if (straighten ? !sails_fit(x, fit) : best < aim)
    return false;
  m_.vertex[size_t(v)] = kind;
  m_.point[size_t(v)] = x;
  for (Candidate& c : now_)
    if (!judge(c, above))
      return false;
  if (lack(now_) > lack(ring_.element))
    return false;
  old_ = ring_.element;
  rim_.clear();
  if (!replace(old_, now_, !ring_.border.empty()))
    return false;
  room_.vertex.pop_back();
  ++counts.splits;
  return true;
}

} // namespace molmesh::improve
