// edge_split.cpp — a new vertex on an edge, where its elements are best.
#include "optimize/operations/editor.hpp"
#include <algorithm>

namespace molmesh::optimize {

bool Editor::split(int32_t e, int i, int j) {
  const auto& v = m_.element[e].v;
  Failures::Attempt attempt{.operation = Failures::Operation::split, .a = v[i], .b = v[j], .element = e};
  return !has_failed(attempt) && (halve(e, i, j) || note_failure(attempt));
}

bool Editor::halve(int32_t e, int i, int j) {
  const int32_t a = m_.element[e].v[i], b = m_.element[e].v[j];
  if (!ring(e, a, b, ring_))
    return false;
  if (room_.vertex.empty() || !has_room(ring_.element.size(), 2 * ring_.element.size())) {
    elsewhere_ = true;
    return false;
  }
  if (target_ && norm(m_.point[a] - m_.point[b]) < 0.3 * target_->spacing())
    return false;
  Vertex kind;
  if (!ring_.border.empty()) {
    if (ring_.border.size() != 2 || ring_.label[0] != ring_.label[1])
      return false;
    const Label& label = m_.labels[ring_.label[0]];
    kind.label = ring_.label[0];
    kind.crowded = m_.vertex[a].crowded || m_.vertex[b].crowded;
    kind.kind = label.curved() ? Kind::surface : Kind::sliding;
    if (!label.curved())
      kind.frozen = static_cast<uint8_t>(1 << label.axis);
    if (label.curved() && !target_)
      return false;
  }
  const float before = worst(ring_.element), aim = before + 1e-8f + 0.02f * before;
  const float above = straighten ? demand(before) : before;
  now_.clear();
  star_quality_.clear(0.5 * (m_.point[a] + m_.point[b]));
  sails_.clear();
  const int32_t v = room_.vertex.back(), ends[2] = {a, b};
  for (const int32_t t : ring_.element) {
    const Element& el = m_.element[t];
    for (const int32_t end : ends) {
      Candidate c{el.v, el.region, 0, {}};
      const int k = el.find(end);
      std::array<Vec3d, 4> p;
      for (size_t n = 0; n < 4; ++n)
        p[n] = m_.point[c.v[n]];
      c.v[k] = v;
      star_quality_.add(p, k);
      now_.push_back(c);
      for (size_t f = 0; f < 4; ++f)
        if (el.label[f] != 0 && el.v[f] != a && el.v[f] != b)
          add_sail(el, f, end);
    }
  }
  Fit fit = fit_of_sails();
  fit.excess /= 2; // each triangle goes with either end
  const Vec3d pa = m_.point[a], pb = m_.point[b];
  const double length = norm(pb - pa);
  Vec3d x = 0.5 * (pa + pb);
  if (!constrain(kind, x, x, guard_.reach * length) || (!straighten && !sails_fit(x, fit)))
    return false;
  float best = star_quality_.worst(x, 0.25f * before);
  if (!(best > 0.25f * before))
    return false; // too far from a gain to search for it
  if (straighten)
    best = worth(x, above);
  search(kind, x, best, std::max(goal, aim), length, fit, above);
  if (straighten ? !sails_fit(x, fit) : best < aim)
    return false;
  if (kind.kind == Kind::surface && !m_.walls.clear(x, apart_from_walls * spacing()))
    return false; // the middle may lie in a wall: it sets no measure
  m_.vertex[v] = kind;
  m_.point[v] = x;
  for (Candidate& c : now_)
    if (!judge(c, above))
      return false;
  if (lack(now_) > lack(ring_.element))
    return false;
  old_ = ring_.element;
  clear_rim();
  if (!replace(old_, now_, !ring_.border.empty()))
    return false;
  room_.vertex.pop_back();
  ++counts.splits;
  return true;
}

} // namespace molmesh::optimize
