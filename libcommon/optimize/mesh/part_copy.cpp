// part_copy.cpp — elements and vertices of a part, numbered anew in their order.
#include "optimize/mesh/part_copy.hpp"
#include "base/open_table.hpp"
#include "par/par.hpp"

namespace molmesh::optimize {
namespace {

std::vector<int32_t> numbers_of(std::vector<int32_t> ids, const SmallNumbers& number) {
  for (int32_t& id : ids)
    id = number.find(id);
  return ids;
}

} // namespace

PartCopy copy_part(const DynamicMesh& m, const Parts& parts, const PartRoom& room,
                   const std::vector<int32_t>& slots) {
  PartCopy c;
  c.element = slots;
  for (const int32_t t : slots)
    for (const int32_t n : m.element[t].n)
      if (n >= 0)
        c.element.push_back(n);
  par::sort_unique(c.element, 1);
  std::vector<int32_t> vertex = room.vertex;
  for (const int32_t t : c.element)
    if (const Element& e = m.element[t]; e.alive())
      vertex.insert(vertex.end(), e.v.begin(), e.v.end());
  par::sort_unique(vertex, 1);
  const SmallNumbers element_number(c.element), vertex_number(vertex);
  c.mesh.labels = m.labels;
  c.mesh.walls = m.walls;
  c.mesh.resize(c.element.size(), vertex.size());
  c.parts.low = parts.low;
  c.parts.cell = parts.cell;
  c.parts.offset = parts.offset;
  c.parts.n = parts.n;
  for (size_t k = 0; k < vertex.size(); ++k) {
    const auto v = size_t(vertex[k]);
    c.parts.owner.push_back(parts.owner[v]);
    if (parts.owner[v] != room.part)
      continue; // another thread may be writing there, and no operation of this part asks
    c.mesh.point[k] = m.point[v];
    c.mesh.vertex[k] = m.vertex[v];
    c.mesh.incident[k] = element_number.find(m.incident[v]);
  }
  for (size_t k = 0; k < c.element.size(); ++k) {
    Element e = m.element[c.element[k]];
    for (size_t i = 0; i < 4; ++i) {
      e.v[i] = vertex_number.find(e.v[i]);
      e.n[i] = element_number.find(e.n[i]);
      if (e.alive() && c.mesh.incident[e.v[i]] < 0)
        c.mesh.incident[e.v[i]] = static_cast<int32_t>(k); // of another part
    }
    c.mesh.element[k] = e;
  }
  c.room = {room.part, numbers_of(room.element, element_number), numbers_of(room.vertex, vertex_number)};
  c.slots = numbers_of(slots, element_number);
  return c;
}

} // namespace molmesh::optimize
