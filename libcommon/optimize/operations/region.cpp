// region.cpp — walks around vertices and edges, what has changed, snapshots.
#include "optimize/operations/region.hpp"
#include "geom/predicates.hpp" // sign of volumes that floating point cannot tell
#include <algorithm>
#include <cassert>
#include <cmath>

namespace molmesh::optimize {

Region::Region(DynamicMesh& m, const Target* t, const FreeTriangles* free, const Parts& parts,
               std::vector<uint32_t>& stamp, PartRoom& r, uint32_t clock)
    : mesh(m), target(t), room(r), crossings(m, free, parts, r.part, stamp), parts_(parts), stamp_(stamp),
      clock_(clock), table_(64) {}

void Region::note_side(int32_t e, size_t face) {
  if (const int32_t v = mesh.element[e].v[face]; parts_.owner[v] == room.part)
    mesh.state[v] = clock_;
  if (log.kept())
    log.add(owned(e) ? e : ChangeLog::beyond);
}

// No other operation writes at this reading of the clock.
void Region::touch(int32_t e) {
  for (const int32_t v : mesh.element[e].v) {
    mesh.touched[v] = time;
    mesh.state[v] = clock_;
  }
}

bool Region::has_failed(const Acceptance& accept, FailedAttempts::Attempt& attempt) {
  if (!(failed_with_ == accept.guard)) {
    failed_ = {};
    failed_with_ = accept.guard;
  }
  attempt.at_a = mesh.state[attempt.a];
  attempt.at_b = attempt.b < 0 ? 0 : mesh.state[attempt.b];
  attempt.goal = accept.goal;
  attempt.aims = static_cast<uint8_t>(accept.worst_first | accept.fits_surface() << 1 | accept.may_bend << 2 |
                                      accept.off_target << 3);
  return failed_.knows(attempt);
}

// At a point with more elements none is worth its time: meshes of molecules have 120 at most.
constexpr size_t most_in_star = 256;
// Of an element: the faces at each corner.
constexpr uint8_t at_corner[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};

// Only our elements are stamped, so no other region sees the stamps.
// Nearly without branches: which faces lead on is not to be guessed.
bool Region::star(int32_t v, std::vector<int32_t>& out) {
  ++clock_;
  const int32_t first = mesh.incident[v];
  if (!owned(first))
    return false;
  const Element* const element = mesh.element.data();
  const int32_t *const owner = parts_.owner.data(), part = room.part;
  uint32_t *const stamp = stamp_.data(), clock = clock_;
  stamp[first] = clock;
  out.resize(std::max<size_t>(out.capacity(), 64));
  out[0] = first;
  size_t found = 1;
  for (size_t i = 0; i < found; ++i) {
    if (found + 4 > out.size())
      out.resize(2 * out.size());
    if (found > most_in_star) {
      looks.done += most_in_star;
      return false;
    }
    const int32_t t = out[i];
    const Element& e = element[t];
    for (const size_t f : at_corner[e.find(v)]) {
      const int32_t next = e.n[f] >= 0 ? e.n[f] : t;
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
  looks.done += static_cast<int64_t>(found);
  return true;
}

bool Region::ring(int32_t e, int32_t a, int32_t b, Ring& r) const {
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
      const Element& el = mesh.element[t];
      size_t behind, ahead;
      at_edge(el, behind, ahead);
      // It shares three vertices with the one before.
      if (r.element.size() > longest || !(t == first ? owned(t) : parts_.owner[el.v[behind]] == room.part))
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
  at_edge(mesh.element[e], behind, ahead);
  const int32_t second = mesh.element[e].n[ahead];
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
    at_edge(mesh.element[start], behind, ahead);
    const int32_t before = mesh.element[start].n[behind];
    if (before < 0)
      return go(start);
    start = before;
  }
}

bool Region::judge(Candidate& c, float above) const {
  c.q = mesh.quality(c.v);
  return is_above(c, above);
}

bool Region::is_above(const Candidate& c, float above) const {
  if (!(c.q > above))
    return false;
  if (c.q > surely_positive)
    return true;
  const auto p = [&](size_t i) { return mesh.point[c.v[i]]; };
  return orient3d(p(0), p(1), p(2), p(3)) > 0;
}

float Region::worst(const std::vector<int32_t>& elements) const {
  float w = 2;
  for (const int32_t e : elements)
    w = std::min(w, mesh.element[e].q);
  return w;
}

// The elements, some of which may be free slots, with their corners and what faces them in other parts.
Snapshot Region::record(std::vector<int32_t> elements) {
  Snapshot s;
  s.room = room;
  s.free_triangles = crossings.changes;
  s.counts = counts;
  if (!std::is_sorted(elements.begin(), elements.end()))
    std::sort(elements.begin(), elements.end());
  s.element.reserve(elements.size());
  s.corner_of.reserve(elements.size());
  corners_.clear();
  for (const int32_t t : elements) {
    const Element& e = mesh.element[t];
    s.element.emplace_back(t, e);
    auto& corner = s.corner_of.emplace_back();
    if (!e.alive())
      continue;
    for (size_t i = 0; i < 4; ++i)
      corner[i] = static_cast<uint32_t>(corners_(e.v[i]));
    for (const int32_t n : e.n) {
      if (n < 0)
        continue;
      const Element& beyond = mesh.element[n];
      const size_t g = beyond.face_towards(t);
      if (parts_.owner[beyond.v[g]] != room.part) // it shares three vertices with one of ours
        s.side.push_back({n, t, static_cast<uint8_t>(g), beyond.label[g]});
    }
  }
  s.corner.reserve(corners_.met().size());
  for (const int32_t v : corners_.met())
    s.corner.push_back({v, mesh.point[v], mesh.vertex[v], mesh.incident[v], mesh.touched[v], mesh.state[v]});
  return s;
}

Snapshot Region::save(const std::vector<int32_t>& inner) {
  Snapshot s = record(inner);
  s.number = ++saved_;
  log.keep();
  s.taken = log.now();
  return s;
}

// Into written_. False where that is not known.
bool Region::written_since(const Snapshot& s) {
  return log.since(restored_ == s.number ? restored_then_ : s.taken, written_);
}

Snapshot Region::changes_since(const Snapshot& before) {
  if (!written_since(before)) { // all of them may be
    written_ = before.room.element;
    for (const auto& [t, e] : before.element)
      written_.push_back(t);
  }
  std::erase(written_, ChangeLog::beyond);
  return record(written_);
}

void Region::redo(const Snapshot& changes) {
  for (const int32_t v : changes.room.vertex)
    mesh.incident[v] = -1;
  write(changes);
  if (!changes.side.empty())
    log.add(ChangeLog::beyond);
  for (const auto& [t, e] : changes.element)
    log.add(t);
  write_sides(changes);
  put_back_rest(changes);
}

// Elements that were written since s was saved, or last brought back, and their corners then: an operation that
// writes a vertex writes an element there. False, and nothing changed, where that is not known or not few.
bool Region::restore_written(const Snapshot& s) {
  constexpr size_t most_log = size_t{1} << 20;
  if (log.size() > most_log || !written_since(s) || 4 * written_.size() > s.element.size())
    return false;
  for (const int32_t t : written_) {
    log.add(t);
    if (t == ChangeLog::beyond)
      continue;
    const auto at = std::lower_bound(s.element.begin(), s.element.end(), t,
                                     [](const auto& e, int32_t id) { return e.first < id; });
    mesh.note_change(t);
    if (at == s.element.end() || at->first != t) { // one in reserve
      mesh.element[t] = {};
      continue;
    }
    mesh.element[t] = at->second;
    for (const uint32_t c : s.corner_of[at - s.element.begin()])
      write(s.corner[c]);
  }
  return true;
}

void Region::restore(const Snapshot& s) {
  for (const int32_t v : s.room.vertex)
    mesh.incident[v] = -1;
  const bool some = restore_written(s);
  if (!some) {
    log.forget();
    for (const int32_t t : s.room.element) {
      mesh.element[t] = {};
      mesh.note_change(t);
    }
    write(s);
  }
  if (!some || (!written_.empty() && written_.front() == ChangeLog::beyond))
    write_sides(s);
  restored_ = s.number;
  restored_then_ = log.now();
  put_back_rest(s);
}

void Region::write(const Snapshot& s) {
  for (const auto& [t, e] : s.element) {
    mesh.element[t] = e;
    mesh.note_change(t);
  }
  for (const Snapshot::Corner& c : s.corner)
    write(c);
}

void Region::write(const Snapshot::Corner& c) {
  mesh.point[c.id] = c.point;
  mesh.vertex[c.id] = c.vertex;
  mesh.incident[c.id] = c.incident;
  mesh.touched[c.id] = c.touched;
  mesh.state[c.id] = c.state;
}

void Region::write_sides(const Snapshot& s) {
  for (const Snapshot::Side& f : s.side) {
    mesh.element[f.element].n[f.face] = f.n;
    mesh.element[f.element].label[f.face] = f.label;
  }
}

// All but the mesh.
void Region::put_back_rest(const Snapshot& s) {
  room = s.room;
  crossings.changes = s.free_triangles;
  counts = s.counts;
  changed.clear();
}

} // namespace molmesh::optimize
