// editor.cpp — stars, rings, and what a set of elements is worth.
#include "optimize/operations/editor.hpp"
#include "geom/predicates.hpp" // sign of volumes that floating point cannot tell
#include <algorithm>
#include <cassert>
#include <cmath>

namespace molmesh::optimize {

Counts& Counts::operator+=(const Counts& o) {
  moves += o.moves;
  edge_removals += o.edge_removals;
  surface_flips += o.surface_flips;
  face_swaps += o.face_swaps;
  contractions += o.contractions;
  splits += o.splits;
  hand_overs += o.hand_overs;
  nestings += o.nestings;
  return *this;
}

Editor::Editor(DynamicMesh& mesh, const Target* target, const Sheets* sheets, const Parts& parts,
               std::vector<uint32_t>& stamp, PartRoom& room, Guard guard, uint32_t clock)
    : m_(mesh), target_(target), sheets_(sheets), changed_sheets_(sheets ? sheets->cell() : 1), parts_(parts),
      stamp_(stamp), room_(room), guard_(guard), most_tilt_(guard.tilt()), clock_(clock), table_(512) {}

bool Editor::owned(int32_t e) const {
  return parts_.owns(room_.part, m_.element[e].v);
}

void Editor::note_side(int32_t e, size_t face) {
  if (const int32_t v = m_.element[e].v[face]; parts_.owner[v] == room_.part)
    m_.state[v] = clock_;
  if (log.kept())
    log.add(owned(e) ? e : ChangeLog::beyond);
}

// No other operation writes at this reading of the clock.
void Editor::touch(int32_t e) {
  for (const int32_t v : m_.element[e].v) {
    m_.touched[v] = time;
    m_.state[v] = clock_;
  }
}

bool Editor::has_failed(Failures::Attempt& attempt) {
  attempt.at_a = m_.state[attempt.a];
  attempt.at_b = attempt.b < 0 ? 0 : m_.state[attempt.b];
  attempt.goal = goal;
  attempt.aims = static_cast<uint8_t>(worst_first | straighten << 1 | bold << 2 | loose << 3);
  elsewhere_ = false;
  return failures_.knows(attempt);
}

bool Editor::note_failure(const Failures::Attempt& attempt) {
  if (!elsewhere_)
    failures_.add(attempt);
  return false;
}

// False when an element of the star is not ours. Only our elements are stamped, so no other editor sees the stamps.
// Nearly without branches: which faces lead on is not to be guessed.
bool Editor::star(int32_t v, std::vector<int32_t>& out) {
  ++clock_;
  const int32_t first = m_.incident[v];
  if (!owned(first))
    return false;
  const Element* const element = m_.element.data();
  const int32_t *const owner = parts_.owner.data(), part = room_.part;
  uint32_t *const stamp = stamp_.data(), clock = clock_;
  stamp[first] = clock;
  out.resize(std::max<size_t>(out.capacity(), 64));
  out[0] = first;
  size_t found = 1;
  for (size_t i = 0; i < found; ++i) {
    if (found + 4 > out.size())
      out.resize(2 * out.size());
    const int32_t t = out[i];
    const Element& e = element[t];
    for (size_t f = 0; f < 4; ++f) {
      const int32_t next = e.v[f] != v && e.n[f] >= 0 ? e.n[f] : t;
      const Element& beyond = element[next];
      const bool fresh = stamp[next] != clock;
      // It shares three vertices with one of ours.
      if (fresh & (owner[beyond.v[beyond.face_towards(t)]] != part))
        return false;
      stamp[next] = clock;
      out[found] = next;
      found += fresh;
    }
  }
  out.resize(found);
  return true;
}

bool Editor::ring(int32_t e, int32_t a, int32_t b, Ring& r) const {
  constexpr size_t longest = 40;
  // Faces of el at the edge with the two others in the order that makes (a, b, c, d) positive: behind lies a b c.
  const auto at_edge = [&](const Element& el, size_t& behind, size_t& ahead) {
    // By the places of a and b: opposite d, and opposite c.
    static constexpr int8_t table[4][4][2] = {{{0, 0}, {3, 2}, {1, 3}, {2, 1}},
                                              {{2, 3}, {0, 0}, {3, 0}, {0, 2}},
                                              {{3, 1}, {0, 3}, {0, 0}, {1, 0}},
                                              {{1, 2}, {2, 0}, {0, 1}, {0, 0}}};
    const auto& f = table[el.find(a)][el.find(b)];
    behind = size_t(f[0]), ahead = size_t(f[1]);
  };
  // From t on until there is no next one, or the next one is t.
  const auto go = [&](int32_t first) {
    r.element.clear();
    r.vertex.clear();
    r.border.clear();
    r.label.clear();
    for (int32_t t = first;;) {
      const Element& el = m_.element[t];
      size_t behind, ahead;
      at_edge(el, behind, ahead);
      // It shares three vertices with the one before.
      if (r.element.size() > longest || !(t == first ? owned(t) : parts_.owner[el.v[behind]] == room_.part))
        return false;
      if (el.label[behind] != 0) {
        r.border.push_back(static_cast<int>(r.vertex.size()));
        r.label.push_back(el.label[behind]);
      }
      r.element.push_back(t);
      r.vertex.push_back(el.v[ahead]);
      const int32_t next = el.n[ahead];
      r.closed = next >= 0;
      if (!r.closed) {
        r.border.push_back(static_cast<int>(r.vertex.size()));
        r.label.push_back(el.label[ahead]);
        r.vertex.push_back(el.v[behind]);
        return true;
      }
      if (next == first)
        return true;
      t = next;
    }
  };
  r.a = a;
  r.b = b;
  size_t behind, ahead;
  at_edge(m_.element[e], behind, ahead);
  const int32_t second = m_.element[e].n[ahead];
  if (second >= 0) {
    if (!go(second))
      return false;
    if (r.closed)
      return true;
  }
  int32_t start = e; // the mesh ends beside the edge: back to where
  for (size_t steps = 0;; ++steps) {
    if (steps > longest || !owned(start))
      return false; // an open ring goes on beyond e
    at_edge(m_.element[start], behind, ahead);
    const int32_t before = m_.element[start].n[behind];
    if (before < 0)
      return go(start);
    start = before;
  }
}

// Sets the quality; false unless it is above `above` and the volume is positive.
bool Editor::judge(Candidate& c, float above) const {
  c.q = m_.quality(c.v);
  return is_above(c, above);
}

bool Editor::is_above(const Candidate& c, float above) const {
  if (!(c.q > above))
    return false;
  if (c.q > surely_positive)
    return true;
  const auto p = [&](size_t i) { return m_.point[c.v[i]]; };
  return orient3d(p(0), p(1), p(2), p(3)) > 0;
}

float Editor::worst(const std::vector<int32_t>& elements) const {
  float w = 2;
  for (const int32_t e : elements)
    w = std::min(w, m_.element[e].q);
  return w;
}

float Editor::lack(const std::vector<int32_t>& elements) const {
  float sum = 0;
  for (const int32_t e : elements)
    sum += lack(m_.element[e].q);
  return sum;
}

float Editor::lack(const std::vector<Candidate>& elements) const {
  float sum = 0;
  for (const Candidate& c : elements)
    sum += lack(c.q);
  return sum;
}

} // namespace molmesh::optimize
