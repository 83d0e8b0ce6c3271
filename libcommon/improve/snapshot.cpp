// snapshot.cpp — a part's elements put by and brought back: operations that are only worth it all together.
#include "improve/editor.hpp"
#include "improve/vertex_numbers.hpp"

namespace molmesh::improve {

Snapshot Editor::save(const std::vector<int32_t>& inner) const {
  Snapshot s;
  s.room = room_;
  s.sheets = changed_sheets_;
  s.counts = counts;
  VertexNumbers vertices;
  for (const int32_t t : inner) {
    const Element& e = m_.element[size_t(t)];
    s.element.emplace_back(t, e);
    for (const int32_t v : e.v)
      vertices(v);
    for (const int32_t n : e.n)
      if (n >= 0 && !owned(n))
        for (size_t g = 0; g < 4; ++g)
          if (const Element& beyond = m_.element[size_t(n)]; beyond.n[g] == t)
            s.side.push_back({n, t, static_cast<uint8_t>(g), beyond.label[g]});
  }
  for (const int32_t v : vertices.met())
    s.corner.push_back(
        {v, m_.point[size_t(v)], m_.vertex[size_t(v)], m_.incident[size_t(v)], m_.touched[size_t(v)]});
  return s;
}

void Editor::restore(const Snapshot& s) {
  for (const int32_t t : s.room.element) {
    m_.element[size_t(t)] = {};
    m_.note_change(t);
  }
  for (const int32_t v : s.room.vertex)
    m_.incident[size_t(v)] = -1;
  for (const auto& [t, e] : s.element) {
    m_.element[size_t(t)] = e;
    m_.note_change(t);
  }
  for (const Snapshot::Corner& c : s.corner) {
    m_.point[size_t(c.id)] = c.point;
    m_.vertex[size_t(c.id)] = c.vertex;
    m_.incident[size_t(c.id)] = c.incident;
    m_.touched[size_t(c.id)] = c.touched;
  }
  for (const Snapshot::Side& f : s.side) {
    m_.element[size_t(f.element)].n[f.face] = f.n;
    m_.element[size_t(f.element)].label[f.face] = f.label;
  }
  room_ = s.room;
  changed_sheets_ = s.sheets;
  counts = s.counts;
  changed.clear();
}

} // namespace molmesh::improve
