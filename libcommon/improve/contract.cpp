// contract.cpp — an edge shrinks to one of its ends; surfaces and walls keep their shape and topology.
#include "improve/editor.hpp"
#include <algorithm>

namespace molmesh::improve {

// For a vertex a on a labelled face: a and b have no neighbours in common but the ring's, on the surface none but
// its two ends, and no triangle over an edge of both links but the ring's (Dey, Edelsbrunner, Guha and Nekhayev
// 1999). Needs star_ = star of a. False too when b's star is not ours.
bool Editor::surface_link_holds(int32_t a, int32_t b, const Ring& r) {
  if (!star(b, star2_))
    return false;
  const auto on_ring = [&](int32_t v) { return std::find(r.vertex.begin(), r.vertex.end(), v) - r.vertex.begin(); };
  const auto size = static_cast<std::ptrdiff_t>(r.vertex.size());
  std::vector<int32_t> near_a, surface_a, surface_b;
  const auto surface_of = [&](const std::vector<int32_t>& elements, int32_t v, std::vector<int32_t>& out) {
    for (const int32_t t : elements) {
      const Element& e = m_.element[size_t(t)];
      for (size_t f = 0; f < 4; ++f) {
        if (e.label[f] == 0 || e.v[f] == v)
          continue;
        for (size_t k = 0; k < 4; ++k)
          if (k != f && e.v[k] != v)
            out.push_back(e.v[k]);
      }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
  };
  for (const int32_t t : star_)
    for (const int32_t v : m_.element[size_t(t)].v)
      if (v != a && v != b)
        near_a.push_back(v);
  std::sort(near_a.begin(), near_a.end());
  const auto beside_a = [&](int32_t v) { return std::binary_search(near_a.begin(), near_a.end(), v); };
  for (const int32_t t : star2_) {
    const Element& e = m_.element[size_t(t)];
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
          if (m_.element[size_t(u)].find(e.v[x]) >= 0 && m_.element[size_t(u)].find(e.v[y]) >= 0)
            return false;
      }
    }
  }
  surface_of(star_, a, surface_a);
  surface_of(star2_, b, surface_b);
  std::vector<int32_t> common;
  std::set_intersection(surface_a.begin(), surface_a.end(), surface_b.begin(), surface_b.end(),
                        std::back_inserter(common));
  return common.size() == 2 && surface_a.size() > 3;
}

bool Editor::contract(int32_t e, int i, int j) {
  const int32_t a = m_.element[size_t(e)].v[size_t(i)], b = m_.element[size_t(e)].v[size_t(j)];
  const Vertex &ka = m_.vertex[size_t(a)], &kb = m_.vertex[size_t(b)];
  if (ka.kind == Kind::fixed || (ka.kind != Kind::interior && kb.kind == Kind::interior))
    return false;
  if (ka.kind == Kind::sliding && kb.kind == Kind::sliding && (ka.frozen & ~kb.frozen) != 0)
    return false;
  if (!star(a, star_))
    return false;
  const float before = worst(star_), above = before + 1e-5f + 0.01f * before;
  now_.clear();
  for (const int32_t t : star_) {
    const Element& el = m_.element[size_t(t)];
    if (el.find(b) >= 0)
      continue;
    Candidate c{el.v, el.region, 0, {}};
    for (size_t f = 0; f < 4; ++f)
      if (el.n[f] < 0)
        c.outside[f] = el.label[f];
    c.v[size_t(el.find(a))] = b;
    if (!judge(c, above))
      return false;
    now_.push_back(c);
  }
  if (ka.kind != Kind::interior) {
    if (!ring(e, a, b, ring_) || ring_.border.size() != 2)
      return false;
    const bool crease = ka.kind == Kind::sliding && (ka.frozen & (ka.frozen - 1)) != 0;
    if ((ring_.label[0] != ring_.label[1]) != crease)
      return false;
    double limit = 1, fit = 0;
    const Vec3d pb = m_.point[size_t(b)];
    for (const int32_t t : star_) {
      const Element& el = m_.element[size_t(t)];
      const int fa = el.find(a), fb = el.find(b);
      for (int f = 0; f < 4; ++f) {
        if (f == fa || el.label[size_t(f)] == 0)
          continue;
        limit = std::max(limit, misfit_face(el, size_t(f), -1, {}));
        if (fb >= 0 && f != fb)
          continue; // the triangle goes
        // The element between goes: the face beyond it takes the label.
        if (f == fb && (crease || el.label[size_t(fa)] != 0 || el.n[size_t(fa)] < 0))
          return false;
        fit = std::max(fit, misfit_face(el, size_t(f), a, pb));
      }
    }
    if (fit > limit || !surface_link_holds(a, b, ring_))
      return false;
  }
  old_ = star_;
  replace(old_, now_);
  m_.incident[size_t(a)] = -1;
  room_.vertex.push_back(a);
  ++counts.contractions;
  return true;
}

} // namespace molmesh::improve
