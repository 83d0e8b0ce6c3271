// moves.cpp — vertices move: pattern search for the worst element, and settling on the target.
#include "improve/editor.hpp"
#include "improve/search.hpp"
#include <algorithm>

namespace molmesh::improve {
namespace {

thread_local Spokes spokes;

// Directions a vertex may take: all, the free axes, or the plane across the normal.
int basis_of(const Vertex& k, const Target* target, Vec3d x, Vec3d basis[3]) {
  int n = 0;
  if (k.kind == Kind::fixed)
    return 0;
  if (k.kind != Kind::surface) {
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

bool Editor::smooth(int32_t v, float goal) {
  const Vertex& k = m_.vertex[size_t(v)];
  if (k.kind == Kind::fixed || !star(v, star_))
    return false;
  const float before = worst(star_);
  if (before >= goal)
    return false;
  const Vec3d from = m_.point[size_t(v)];
  Vec3d basis[3];
  const int dimensions = basis_of(k, target_, from, basis);
  if (dimensions == 0)
    return false;
  spokes.clear();
  double length = 0, limit = 1;
  for (const int32_t t : star_) {
    const Element& e = m_.element[size_t(t)];
    const int i = e.find(v);
    std::array<Vec3d, 4> p;
    for (size_t j = 0; j < 4; ++j) {
      p[j] = m_.point[size_t(e.v[j])];
      length += norm(p[j] - from);
    }
    spokes.add(p, i);
    for (size_t f = 0; f < 4; ++f)
      if (e.label[f] != 0 && f != size_t(i))
        limit = std::max(limit, misfit_face(e, f, v, from));
  }
  length /= 3. * double(star_.size());
  const auto accept = [&](Vec3d y) {
    if (k.kind != Kind::surface)
      return true;
    for (const int32_t t : star_) {
      const Element& e = m_.element[size_t(t)];
      for (size_t f = 0; f < 4; ++f)
        if (e.label[f] != 0 && e.v[f] != v && misfit_face(e, f, v, y) > limit)
          return false;
    }
    return true;
  };
  Vec3d x = from;
  float best = before;
  if (!pattern_search(
          spokes, x, best, goal, length, basis, dimensions,
          [&](Vec3d& y) { return constrain(v, y, guard_.reach * length); }, accept))
    return false;
  m_.point[size_t(v)] = x;
  now_.clear();
  bool good = true;
  for (const int32_t t : star_) {
    const Element& e = m_.element[size_t(t)];
    now_.push_back({e.v, e.region, 0, {}});
    good = good && judge(now_.back(), before);
  }
  if (!good) {
    m_.point[size_t(v)] = from;
    return false;
  }
  for (size_t i = 0; i < star_.size(); ++i)
    m_.element[size_t(star_[i])].q = now_[i].q;
  changed.insert(changed.end(), star_.begin(), star_.end());
  ++counts.moves;
  return true;
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
  double length = 0;
  for (const int32_t t : star_)
    for (const int32_t w : m_.element[size_t(t)].v)
      length += norm(m_.point[size_t(w)] - from);
  length /= 3. * double(star_.size());
  Vec3d to = from;
  if (!target_->project(to, guard_.reach * length))
    return false;
  const float above = std::min(floor, worst(star_)) * 0.999999f;
  for (double step = 1; step > 0.1; step *= 0.5) {
    m_.point[size_t(v)] = step == 1 ? to : from + step * (to - from);
    now_.clear();
    bool good = true;
    for (const int32_t t : star_) {
      const Element& e = m_.element[size_t(t)];
      now_.push_back({e.v, e.region, 0, {}});
      good = good && judge(now_.back(), above);
      if (!good)
        break;
    }
    if (!good)
      continue;
    for (size_t i = 0; i < star_.size(); ++i)
      m_.element[size_t(star_[i])].q = now_[i].q;
    ++counts.moves;
    return true;
  }
  m_.point[size_t(v)] = from;
  return false;
}

bool Editor::split(int32_t e, int i, int j) {
  const int32_t a = m_.element[size_t(e)].v[size_t(i)], b = m_.element[size_t(e)].v[size_t(j)];
  if (room_.vertex.empty() || !ring(e, a, b, ring_) || !has_room(ring_.element.size(), 2 * ring_.element.size()))
    return false;
  const size_t borders = ring_.border.size();
  Vertex kind;
  if (borders != 0) {
    if (borders != 2 || ring_.label[0] != ring_.label[1])
      return false;
    const Label& label = m_.labels[ring_.label[0]];
    kind.label = ring_.label[0];
    kind.kind = label.curved() ? Kind::surface : Kind::sliding;
    if (!label.curved())
      kind.frozen = static_cast<uint8_t>(1 << label.axis);
    if (label.curved() && !target_)
      return false;
  }
  const Vec3d pa = m_.point[size_t(a)], pb = m_.point[size_t(b)];
  const double length = norm(pb - pa);
  Vec3d x = 0.5 * (pa + pb);
  const int32_t v = room_.vertex.back();
  m_.vertex[size_t(v)] = kind;
  m_.point[size_t(v)] = x;
  const float before = worst(ring_.element);
  double limit = 1;
  now_.clear();
  spokes.clear();
  for (const int32_t t : ring_.element) {
    const Element& el = m_.element[size_t(t)];
    const int32_t ends[2] = {a, b};
    for (const int32_t end : ends) {
      Candidate c{el.v, el.region, 0, {}};
      const int k = el.find(end);
      c.v[size_t(k)] = v;
      std::array<Vec3d, 4> p;
      for (size_t n = 0; n < 4; ++n)
        p[n] = m_.point[size_t(c.v[n])];
      spokes.add(p, k);
      now_.push_back(c);
    }
    for (size_t f = 0; f < 4; ++f)
      if (el.label[f] != 0 && el.v[f] != a && el.v[f] != b)
        limit = std::max(limit, misfit_face(el, f, -1, {}));
  }
  const auto fits = [&](Vec3d y) {
    if (kind.kind != Kind::surface)
      return true;
    for (const int32_t t : ring_.element) {
      const Element& el = m_.element[size_t(t)];
      for (size_t f = 0; f < 4; ++f)
        if (el.label[f] != 0 && el.v[f] != a && el.v[f] != b &&
            (misfit_face(el, f, a, y) > limit || misfit_face(el, f, b, y) > limit))
          return false;
    }
    return true;
  };
  const auto bound = [&](Vec3d& y) { return constrain(v, y, guard_.reach * length); };
  Vec3d basis[3];
  if (!bound(x) || !fits(x))
    return false;
  const int dimensions = basis_of(kind, target_, x, basis);
  float best = spokes.worst(x, -1);
  if (!(best > 0))
    return false;
  const float aim = before + 1e-4f + 0.02f * before;
  pattern_search(spokes, x, best, 0.3f, length, basis, dimensions, bound, fits);
  if (best < aim)
    return false;
  m_.point[size_t(v)] = x;
  for (Candidate& c : now_)
    if (!judge(c, before))
      return false;
  room_.vertex.pop_back();
  old_ = ring_.element;
  replace(old_, now_);
  ++counts.splits;
  return true;
}

} // namespace molmesh::improve
