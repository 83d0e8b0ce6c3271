// snapshot.cpp — a part's elements put by and brought back: operations that are only worth it all together.
#include "optimize/mesh/vertex_numbers.hpp"
#include "optimize/operations/editor.hpp"
#include <algorithm>

namespace molmesh::optimize {

Snapshot Editor::save(const std::vector<int32_t>& inner) {
  Snapshot s;
  s.room = room_;
  s.sheets = changed_sheets_;
  s.counts = counts;
  s.number = ++saved_;
  log.keep();
  s.taken = log.now();
  std::vector<int32_t> ascending = inner;
  if (!std::is_sorted(ascending.begin(), ascending.end()))
    std::sort(ascending.begin(), ascending.end());
  s.element.reserve(ascending.size());
  s.corner_of.reserve(ascending.size());
  VertexNumbers vertices;
  for (const int32_t t : ascending) {
    const Element& e = m_.element[t];
    s.element.emplace_back(t, e);
    auto& corner = s.corner_of.emplace_back();
    for (size_t i = 0; i < 4; ++i)
      corner[i] = static_cast<uint32_t>(vertices(e.v[i]));
    for (const int32_t n : e.n) {
      if (n < 0)
        continue;
      const Element& beyond = m_.element[n];
      const size_t g = beyond.face_towards(t);
      if (parts_.owner[beyond.v[g]] != room_.part) // it shares three vertices with one of ours
        s.side.push_back({n, t, static_cast<uint8_t>(g), beyond.label[g]});
    }
  }
  s.corner.reserve(vertices.met().size());
  for (const int32_t v : vertices.met())
    s.corner.push_back({v, m_.point[v], m_.vertex[v], m_.incident[v], m_.touched[v], m_.state[v]});
  return s;
}

// Elements that were written since s was saved, or last brought back, and their corners then: an operation that
// writes a vertex writes an element there. False, and nothing changed, where that is not known or not few.
bool Editor::restore_written(const Snapshot& s) {
  constexpr size_t most_log = size_t{1} << 20;
  if (log.size() > most_log || !log.since(restored_ == s.number ? restored_then_ : s.taken, written_) ||
      4 * written_.size() > s.element.size())
    return false;
  for (const int32_t t : written_) {
    log.add(t);
    if (t == ChangeLog::beyond)
      continue;
    const auto at = std::lower_bound(s.element.begin(), s.element.end(), t,
                                     [](const auto& e, int32_t id) { return e.first < id; });
    m_.note_change(t);
    if (at == s.element.end() || at->first != t) { // one in reserve
      m_.element[t] = {};
      continue;
    }
    m_.element[t] = at->second;
    for (const uint32_t c : s.corner_of[at - s.element.begin()]) {
      const Snapshot::Corner& corner = s.corner[c];
      m_.point[corner.id] = corner.point;
      m_.vertex[corner.id] = corner.vertex;
      m_.incident[corner.id] = corner.incident;
      m_.touched[corner.id] = corner.touched;
      m_.state[corner.id] = corner.state;
    }
  }
  return true;
}

void Editor::restore(const Snapshot& s) {
  for (const int32_t v : s.room.vertex)
    m_.incident[v] = -1;
  const bool some = restore_written(s);
  if (!some) {
    log.forget();
    for (const int32_t t : s.room.element) {
      m_.element[t] = {};
      m_.note_change(t);
    }
    for (const auto& [t, e] : s.element) {
      m_.element[t] = e;
      m_.note_change(t);
    }
    for (const Snapshot::Corner& c : s.corner) {
      m_.point[c.id] = c.point;
      m_.vertex[c.id] = c.vertex;
      m_.incident[c.id] = c.incident;
      m_.touched[c.id] = c.touched;
      m_.state[c.id] = c.state;
    }
  }
  if (!some || (!written_.empty() && written_.front() == ChangeLog::beyond))
    for (const Snapshot::Side& f : s.side) {
      m_.element[f.element].n[f.face] = f.n;
      m_.element[f.element].label[f.face] = f.label;
    }
  restored_ = s.number;
  restored_then_ = log.now();
  room_ = s.room;
  changed_sheets_ = s.sheets;
  counts = s.counts;
  changed.clear();
}

} // namespace molmesh::optimize
