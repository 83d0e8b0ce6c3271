// editor.cpp — stars, rings, and what a set of elements is worth.
#include "improve/editor.hpp"
#include "geom/predicates.hpp" // sign of volumes that floating point cannot tell
#include <algorithm>
#include <cassert>
#include <cmath>

namespace molmesh::improve {

Counts& Counts::operator+=(const Counts& o) {
  moves += o.moves;
  edge_removals += o.edge_removals;
  surface_flips += o.surface_flips;
  face_swaps += o.face_swaps;
  contractions += o.contractions;
  splits += o.splits;
  hand_overs += o.hand_overs;
  return *this;
}

Editor::Editor(DynamicMesh& mesh, const Target* target, const Sheets* sheets, const Parts& parts,
               std::vector<uint32_t>& stamp, PartRoom& room, Guard guard)
    : m_(mesh), target_(target), sheets_(sheets), changed_sheets_(target ? target->spacing() : 1), parts_(parts),
      stamp_(stamp), room_(room), guard_(guard), table_(512) {}

bool Editor::owned(int32_t e) const {
  return parts_.owns(room_.part, m_.element[size_t(e)].v);
}

// False when an element of the star is not ours. Only our elements are stamped, so no other editor sees the stamps.
bool Editor::star(int32_t v, std::vector<int32_t>& out) {
  out.clear();
  ++clock_;
  const int32_t first = m_.incident[size_t(v)];
  if (!owned(first))
    return false;
  stamp_[size_t(first)] = clock_;
  out.push_back(first);
  for (size_t i = 0; i < out.size(); ++i) {
    const Element& e = m_.element[size_t(out[i])];
    for (size_t f = 0; f < 4; ++f) {
      const int32_t n = e.n[f];
      if (e.v[f] == v || n < 0 || stamp_[size_t(n)] == clock_)
        continue;
      if (!owned(n))
        return false;
      stamp_[size_t(n)] = clock_;
      out.push_back(n);
    }
  }
  return true;
}

bool Editor::ring(int32_t e, int32_t a, int32_t b, Ring& r) const {
  constexpr size_t longest = 40;
  // The two others, in the order that makes (a, b, c, d) positive.
  const auto others = [&](int32_t t, int32_t& c, int32_t& d) {
    const Element& el = m_.element[size_t(t)];
    const int i = el.find(a), j = el.find(b);
    int k = 0;
    while (k == i || k == j)
      ++k;
    const int l = 6 - i - j - k;
    c = el.v[size_t(k)];
    d = el.v[size_t(l)];
    const bool odd = ((i > j) + (i > k) + (i > l) + (j > k) + (j > l) + (k > l)) & 1;
    if (odd)
      std::swap(c, d);
  };
  r.a = a;
  r.b = b;
  r.closed = true;
  int32_t start = e, c, d;
  for (size_t steps = 0;; ++steps) { // back to the outside, or once around
    if (steps > longest || !owned(start))
      return false;
    others(start, c, d);
    const Element& el = m_.element[size_t(start)];
    const int32_t before = el.n[size_t(el.find(d))];
    if (before < 0) {
      r.closed = false;
      break;
    }
    if (before == e)
      break;
    start = before;
  }
  r.element.clear();
  r.vertex.clear();
  r.border.clear();
  r.label.clear();
  for (int32_t t = start;;) {
    if (r.element.size() > longest || !owned(t))
      return false; // an open ring goes on beyond e
    others(t, c, d);
    const Element& el = m_.element[size_t(t)];
    const size_t behind = size_t(el.find(d)), ahead = size_t(el.find(c));
    if (el.label[behind] != 0) {
      r.border.push_back(static_cast<int>(r.vertex.size()));
      r.label.push_back(el.label[behind]);
    }
    r.element.push_back(t);
    r.vertex.push_back(c);
    const int32_t next = el.n[ahead];
    if (next < 0) {
      r.border.push_back(static_cast<int>(r.vertex.size()));
      r.label.push_back(el.label[ahead]);
      r.vertex.push_back(d);
      return true;
    }
    if (next == start)
      return true;
    t = next;
  }
}

// Sets the quality; false unless it is above `above` and the volume is positive.
bool Editor::judge(Candidate& c, float above) const {
  c.q = m_.quality(c.v);
  if (!(c.q > above))
    return false;
  if (c.q > 1e-6f)
    return true;
  const auto p = [&](size_t i) { return m_.point[size_t(c.v[i])]; };
  return orient3d(p(0), p(1), p(2), p(3)) > 0;
}

float Editor::worst(const std::vector<int32_t>& elements) const {
  float w = 2;
  for (const int32_t e : elements)
    w = std::min(w, m_.element[size_t(e)].q);
  return w;
}

float Editor::lack(const std::vector<int32_t>& elements) const {
  float sum = 0;
  for (const int32_t e : elements)
    sum += lack(m_.element[size_t(e)].q);
  return sum;
}

float Editor::lack(const std::vector<Candidate>& elements) const {
  float sum = 0;
  for (const Candidate& c : elements)
    sum += lack(c.q);
  return sum;
}

} // namespace molmesh::improve
