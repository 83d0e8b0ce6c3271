// editor.cpp — stars, rings, guards, and the exchange of a cavity's elements.
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
  return *this;
}

Editor::Editor(DynamicMesh& mesh, const Target* target, const std::vector<int32_t>& owner,
               std::vector<uint32_t>& stamp, PartRoom& room, Guard guard)
    : m_(mesh), target_(target), owner_(owner), stamp_(stamp), room_(room), guard_(guard), table_(512) {}

bool Editor::owned(int32_t e) const {
  const auto& v = m_.element[size_t(e)].v;
  return owner_[size_t(v[0])] == room_.part && owner_[size_t(v[1])] == room_.part &&
         owner_[size_t(v[2])] == room_.part && owner_[size_t(v[3])] == room_.part;
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

// Whether the face, seen as an outward one of e, runs as the target's normal does.
bool Editor::outward(const Element& e, size_t face) const {
  const bool lower = e.n[face] < 0 || e.region < m_.element[size_t(e.n[face])].region;
  return lower != m_.labels[e.label[face]].reversed;
}

double Editor::misfit(Vec3d a, Vec3d b, Vec3d c) const {
  return improve::misfit(*target_, guard_, a, b, c);
}

// Of a labelled face with vertex `from` put at `at`; 0 for flat labels and without a target.
double Editor::misfit_face(const Element& e, size_t face, int32_t from, Vec3d at) const {
  if (!target_ || !m_.labels[e.label[face]].curved())
    return 0;
  std::array<Vec3d, 3> p;
  for (size_t i = 0; i < 3; ++i) {
    const int32_t v = e.v[size_t(outward_face[face][i])];
    p[i] = v == from ? at : m_.point[size_t(v)];
  }
  return outward(e, face) ? misfit(p[0], p[1], p[2]) : misfit(p[0], p[2], p[1]);
}

// Moves a trial x of a vertex at `from` onto what it is bound to.
bool Editor::constrain(const Vertex& k, Vec3d from, Vec3d& x, double reach) const {
  switch (k.kind) {
  case Kind::interior:
    return true;
  case Kind::surface:
    // The distance to first order means nothing where the gradient vanishes, and that is where points must leave.
    if (target_ && guard_.lift > 0)
      return norm(x - from) <= guard_.lift * target_->spacing();
    return target_ && target_->project(x, reach);
  case Kind::sliding:
    for (int a = 0; a < 3; ++a)
      if (k.frozen >> a & 1)
        x[a] = from[a];
    return true;
  case Kind::fixed:
    break;
  }
  return false;
}

Editor::FaceEntry& Editor::entry(int32_t a, int32_t b, int32_t c) {
  if (a > b)
    std::swap(a, b);
  if (b > c)
    std::swap(b, c);
  if (a > b)
    std::swap(a, b);
  const uint64_t h = (uint64_t(uint32_t(a)) * 0x9E3779B97F4A7C15u) ^ (uint64_t(uint32_t(b)) * 0xC2B2AE3D27D4EB4Fu) ^
                     (uint64_t(uint32_t(c)) * 0x165667B19E3779F9u);
  const size_t mask = table_.size() - 1;
  for (size_t i = size_t(h >> 40) & mask;; i = (i + 1) & mask) {
    FaceEntry& f = table_[i];
    if (f.clock != table_clock_) {
      f = {a, b, c, -1, 0, 0, false, false, table_clock_};
      return f;
    }
    if (f.a == a && f.b == b && f.c == c)
      return f;
  }
}

// The new elements fill the old ones' place up to faces on the outside that changed: those get the label of the
// ones that went.
void Editor::replace(const std::vector<int32_t>& old, const std::vector<Candidate>& now) {
  while (table_.size() < 16 * (old.size() + now.size()))
    table_.resize(2 * table_.size());
  ++table_clock_;
  ++clock_;
  for (const int32_t e : old)
    stamp_[size_t(e)] = clock_;
  uint8_t inner = 0, outside = 0;
  int64_t open = 0;
  const auto face_of = [](const Element& e, size_t f) {
    const auto& o = outward_face[f];
    return std::array<int32_t, 3>{e.v[size_t(o[0])], e.v[size_t(o[1])], e.v[size_t(o[2])]};
  };
  for (const int32_t t : old) {
    const Element& e = m_.element[size_t(t)];
    for (size_t f = 0; f < 4; ++f) {
      const int32_t n = e.n[f];
      if (n >= 0 && stamp_[size_t(n)] == clock_) {
        if (e.label[f] != 0)
          inner = e.label[f];
        continue;
      }
      const auto v = face_of(e, f);
      FaceEntry& x = entry(v[0], v[1], v[2]);
      x.element = n;
      x.label = e.label[f];
      x.open = x.outer = true;
      ++open;
      if (n < 0)
        continue;
      for (const int32_t w : v)
        m_.incident[size_t(w)] = n; // where nothing new comes
      const Element& beyond = m_.element[size_t(n)];
      for (size_t g = 0; g < 4; ++g)
        if (beyond.n[g] == t)
          x.face = static_cast<uint8_t>(g);
    }
  }
  size_t reused = 0;
  std::vector<int32_t>& made = star2_;
  made.clear();
  for (const Candidate& c : now) {
    int32_t id;
    if (reused < old.size())
      id = old[reused++];
    else
      id = room_.element.back(), room_.element.pop_back();
    made.push_back(id);
    Element& e = m_.element[size_t(id)];
    e = {};
    e.v = c.v;
    e.region = c.region;
    e.q = c.q;
    e.label = c.outside;
    for (const int32_t v : c.v) {
      m_.incident[size_t(v)] = id;
      m_.touched[size_t(v)] = time;
    }
  }
  for (; reused < old.size(); ++reused) {
    m_.element[size_t(old[reused])] = {};
    room_.element.push_back(old[reused]);
  }
  const auto join = [&](int32_t a, size_t f, int32_t b, size_t g, uint8_t label) {
    Element &x = m_.element[size_t(a)], &y = m_.element[size_t(b)];
    x.n[f] = b;
    y.n[g] = a;
    x.label[f] = y.label[g] = x.region == y.region ? uint8_t{0} : label;
  };
  for (const int32_t id : made)
    for (size_t f = 0; f < 4; ++f) {
      const auto v = face_of(m_.element[size_t(id)], f);
      FaceEntry& x = entry(v[0], v[1], v[2]);
      if (!x.open) {
        x.open = true;
        ++open;
        x.element = id;
        x.face = static_cast<uint8_t>(f);
        continue;
      }
      x.open = false;
      --open;
      if (x.element >= 0)
        join(id, f, x.element, x.face, x.label != 0 ? x.label : inner);
      else
        m_.element[size_t(id)].label[f] = x.label;
    }
  // What stays open: old outside faces that went, and new ones.
  for (int pass = 0; open > 0 && pass < 2; ++pass)
    for (FaceEntry& x : table_) {
      if (x.clock != table_clock_ || !x.open)
        continue;
      if (pass == 0 && x.outer && x.element < 0)
        outside = x.label;
      if (pass == 1 && x.element >= 0) {
        Element& e = m_.element[size_t(x.element)];
        e.n[x.face] = -1;
        if (e.label[x.face] == 0)
          e.label[x.face] = outside;
      }
    }
  changed.insert(changed.end(), made.begin(), made.end());
}

} // namespace molmesh::improve
