// edge_contraction.cpp — an edge shrinks to one of its ends; surfaces and walls keep their shape and topology.
#include "optimize/operations/editor.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::optimize {

// For a vertex a on a labelled face: a and b have no neighbours in common but the ring's, on the surface none but
// its two ends, and no triangle over an edge of both links but the ring's (Dey, Edelsbrunner, Guha and Nekhayev
// 1999). Needs star_ = star of a, star2_ = star of b.
bool Editor::surface_link_holds(int32_t a, int32_t b, const Ring& r) {
  const auto on_ring = [&](int32_t v) { return std::find(r.vertex.begin(), r.vertex.end(), v) - r.vertex.begin(); };
  const auto size = static_cast<std::ptrdiff_t>(r.vertex.size());
  std::vector<int32_t> near_a, surface_a, surface_b;
  const auto surface_of = [&](const std::vector<int32_t>& elements, int32_t v, std::vector<int32_t>& out) {
    for (const int32_t t : elements) {
      const Element& e = m_.element[t];
      for (size_t f = 0; f < 4; ++f) {
        if (e.label[f] == 0 || e.v[f] == v)
          continue;
        for (size_t k = 0; k < 4; ++k)
          if (k != f && e.v[k] != v)
            out.push_back(e.v[k]);
      }
    }
    par::sort_unique(out, 1);
  };
  for (const int32_t t : star_)
    for (const int32_t v : m_.element[t].v)
      if (v != a && v != b)
        near_a.push_back(v);
  std::sort(near_a.begin(), near_a.end());
  const auto beside_a = [&](int32_t v) { return std::binary_search(near_a.begin(), near_a.end(), v); };
  for (const int32_t t : star2_) {
    const Element& e = m_.element[t];
    if (e.find(a) >= 0)
      continue;
    for (size_t x = 0; x < 4; ++x) {
      if (e.v[x] == b || !beside_a(e.v[x]))
        continue;
      const auto i = on_ring(e.v[x]);
      if (i == size)
        return false;
      for (size_t y = x + 1; y < 4; ++y) {
        if (e.v[y] == b || !beside_a(e.v[y]))
          continue;
        const auto j = on_ring(e.v[y]);
        const auto gap = std::abs(i - j);
        if (j == size || gap == 1 || (r.closed && gap == size - 1))
          continue;
        for (const int32_t u : star_)
          if (m_.element[u].find(e.v[x]) >= 0 && m_.element[u].find(e.v[y]) >= 0)
            return false;
      }
    }
  }
  surface_of(star_, a, surface_a);
  surface_of(star2_, b, surface_b);
  std::vector<int32_t> common;
  std::set_intersection(surface_a.begin(), surface_a.end(), surface_b.begin(), surface_b.end(),
                        std::back_inserter(common));
  return common.size() == r.border.size() && surface_a.size() > 3;
}

bool Editor::may_contract(const Vertex& a, const Vertex& b) const {
  if (a.kind == Kind::fixed || (a.kind != Kind::interior && b.kind == Kind::interior))
    return false;
  if (a.kind == Kind::trace)
    return b.kind == Kind::fixed || (b.kind == Kind::trace && a.frozen == b.frozen);
  return a.kind != Kind::sliding || b.kind != Kind::sliding || (a.frozen & ~b.frozen) == 0;
}

// For a on a labelled face: the edge a b runs in all its labels, and its elements may go. Sets ring_.
bool Editor::borders_allow(int32_t e, int32_t a, int32_t b) {
  const Vertex& ka = m_.vertex[a];
  if (!ring(e, a, b, ring_))
    return false;
  const bool trace = ka.kind == Kind::trace;
  const bool crease = trace || (ka.kind == Kind::sliding && (ka.frozen & (ka.frozen - 1)) != 0);
  const auto& label = ring_.label;
  // Where a wall meets a surface with elements on both sides its triangle is between two of the wall's.
  if (label.size() == 3 ? !trace || label[1] == label[0] || label[1] == label[2]
                        : label.size() != 2 || (label[0] != label[1]) != crease)
    return false;
  if (trace && std::any_of(ring_.border.begin(), ring_.border.end(), [&](int k) { // a loop of three may lie there
        const Kind kind = m_.vertex[ring_.vertex[k]].kind;
        return kind == Kind::trace || kind == Kind::fixed;
      }))
    return false;
  for (const int32_t t : ring_.element) { // they go: the faces beyond them take their labels
    const Element& el = m_.element[t];
    const size_t fa = size_t(el.find(a)), fb = size_t(el.find(b));
    if (el.label[fb] != 0 && (crease || el.label[fa] != 0 || el.n[fa] < 0))
      return false;
    if (el.n[fb] < 0 && el.n[fa] < 0)
      return false;
  }
  return true;
}

bool Editor::is_tiny(int32_t e, int i, int j) const {
  const auto p = [&](int k) { return m_.point[m_.element[e].v[k]]; };
  return target_ && norm(p(i) - p(j)) < 0.1 * target_->spacing();
}

bool Editor::contract(int32_t e, int i, int j) {
  const int32_t a = m_.element[e].v[i], b = m_.element[e].v[j];
  const Vertex& ka = m_.vertex[a];
  if (!may_contract(ka, m_.vertex[b]) || !star(a, star_))
    return false;
  const bool tiny = yield < 1 && is_tiny(e, i, j);
  const float before = worst(star_), above = (tiny ? yield : 1.f) * demand(before);
  now_.clear();
  for (const int32_t t : star_) {
    const Element& el = m_.element[t];
    if (el.find(b) >= 0)
      continue;
    Candidate c{el.v, el.region, 0, el.label};
    c.v[el.find(a)] = b;
    if (!judge(c, above))
      return false;
    now_.push_back(c);
  }
  if (lack(now_) > (tiny ? 0.9f : 1.f) * lack(star_))
    return false;
  if (ka.kind != Kind::interior) {
    const Fit fit = gather_sails(star_, a);
    const Vec3d pb = m_.point[b];
    std::erase_if(sails_, [&](const Sail& s) { return s.p[0] == pb || s.p[1] == pb || s.p[2] == pb; });
    if (!sails_fit(pb, fit) || !borders_allow(e, a, b) || !star(b, star2_) || !surface_link_holds(a, b, ring_))
      return false;
  }
  return finish_contraction(a, b, false);
}

// As contract(), but b moves too: both stars are judged at the best place for it.
bool Editor::merge(int32_t e, int i, int j) {
  const auto& v = m_.element[e].v;
  Failures::Attempt attempt{.operation = Failures::Operation::merge, .a = v[i], .b = v[j]};
  return !has_failed(attempt) && (join(e, i, j) || note_failure(attempt));
}

bool Editor::join(int32_t e, int i, int j) {
  int32_t a = m_.element[e].v[i], b = m_.element[e].v[j];
  if (!may_contract(m_.vertex[a], m_.vertex[b]))
    std::swap(a, b);
  const Vertex &ka = m_.vertex[a], &kb = m_.vertex[b];
  if (!may_contract(ka, kb) || ka.kind == Kind::trace || kb.kind == Kind::trace || kb.kind == Kind::fixed ||
      !star(a, star_) || !star(b, star2_))
    return false;
  const float before = std::min(worst(star_), worst(star2_)), above = demand(before);
  const Vec3d pa = m_.point[a], pb = m_.point[b];
  const double length = mean_edge(star2_, b);
  Fit fit = gather_sails(star_, a);
  const std::vector<Sail> sails_a = sails_;
  const Fit fit_b = gather_sails(star2_, b);
  fit.worst = std::max(fit.worst, fit_b.worst);
  fit.excess += fit_b.excess;
  sails_.insert(sails_.end(), sails_a.begin(), sails_a.end());
  std::erase_if(sails_, [&](const Sail& s) { // those on the edge go
    int ends = 0;
    for (const Vec3d& p : s.p)
      ends += (p == pa) + (p == pb);
    if (ends == 2) // found from either end
      fit.excess -= 0.5 * std::max(0., misfit(s.p[0], s.p[1], s.p[2]) - 1);
    return ends == 2;
  });
  star_quality_.clear(pb);
  now_.clear();
  const auto add = [&](const std::vector<int32_t>& elements, int32_t from, int32_t other) {
    for (const int32_t t : elements) {
      const Element& el = m_.element[t];
      if (el.find(other) >= 0)
        continue;
      Candidate c{el.v, el.region, 0, el.label};
      std::array<Vec3d, 4> p;
      for (size_t n = 0; n < 4; ++n)
        p[n] = m_.point[c.v[n]];
      const int k = el.find(from);
      c.v[k] = b;
      star_quality_.add(p, k);
      if (from == a)
        now_.push_back(c);
    }
  };
  add(star_, a, b);
  const size_t made = now_.size();
  add(star2_, b, a);
  Vec3d x = pb;
  float best = star_quality_.worst(pb, 0);
  if (ka.kind == kb.kind && ka.frozen == kb.frozen) {
    Vec3d y = 0.5 * (pa + pb);
    const float q =
        constrain(kb, pb, y, guard_.reach * length) ? star_quality_.worst(y, std::max(best, 0.f)) : -1.f;
    if (q > best)
      best = q, x = y;
  }
  if (!(best > 0.25f * before) || (!straighten && !sails_fit(x, fit)))
    return false;
  if (straighten)
    best = worth(x, above);
  search(kb, x, best, std::max(goal, above), length, fit, above);
  if (straighten ? !sails_fit(x, fit) : best <= above)
    return false;
  if (ka.kind != Kind::interior && (!borders_allow(e, a, b) || !surface_link_holds(a, b, ring_)))
    return false;
  m_.point[b] = x;
  bool good = true;
  for (size_t c = 0; c < made && good; ++c)
    good = judge(now_[c], straighten ? above : before);
  float sum = lack(now_), allowed = lack(star_);
  std::vector<float> q;
  std::vector<int32_t> kept;
  for (size_t t = 0; t < star2_.size() && good; ++t) {
    const Element& el = m_.element[star2_[t]];
    if (el.find(a) >= 0)
      continue;
    Candidate c{el.v, el.region, 0, {}};
    good = judge(c, straighten ? above : before);
    kept.push_back(star2_[t]);
    q.push_back(c.q);
    sum += lack(c.q), allowed += lack(el.q);
  }
  if (!good || sum > allowed) {
    m_.point[b] = pb;
    return false;
  }
  if (!finish_contraction(a, b, kb.kind == Kind::surface)) {
    m_.point[b] = pb;
    return false;
  }
  for (size_t t = 0; t < kept.size(); ++t) {
    m_.element[kept[t]].q = q[t];
    touch(kept[t]);
    note_change(kept[t]);
    changed.push_back(kept[t]);
  }
  return true;
}

// star_ gives way to now_. moved: b has, and is on the surface; its elements are star2_, and stay but for the ring.
bool Editor::finish_contraction(int32_t a, int32_t b, bool moved) {
  old_ = star_;
  bool& crowded = m_.vertex[b].crowded;
  const bool was_crowded = crowded;
  crowded |= m_.vertex[a].crowded;
  clear_rim();
  if (sheets_ && moved)
    list_rim(star2_, b, a);
  if (!replace(old_, now_, m_.vertex[a].kind != Kind::interior, moved)) {
    crowded = was_crowded;
    return false;
  }
  m_.incident[a] = -1;
  m_.touched[b] = time;
  room_.vertex.push_back(a);
  ++counts.contractions;
  if (sheets_ && !moved && crowded && !was_crowded && star(b, star2_)) { // its other triangles may be now, too
    clear_rim();
    list_rim(star2_, b, -1);
  }
  move_rim();
  return true;
}

} // namespace molmesh::optimize
