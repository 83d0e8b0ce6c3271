// check.cpp — every element of a region against its points and its neighbours.
#include "optimize/operations/check.hpp"
#include "base/error.hpp"
#include "geom/predicates.hpp" // exact sign of a volume
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {
namespace {

const char* fault_of(const DynamicMesh& m, int32_t t) {
  const Element& e = m.element[t];
  const auto p = [&](size_t i) { return m.point[e.v[i]]; };
  if (!(orient3d(p(0), p(1), p(2), p(3)) > 0))
    return "no positive volume";
  if (std::abs(e.q - std::max(m.quality(e.v), 0.f)) > 1e-6f)
    return "another quality";
  for (size_t f = 0; f < 4; ++f) {
    const int32_t at = m.incident[e.v[f]];
    if (at < 0 || m.element[at].find(e.v[f]) < 0)
      return "a vertex that knows no element of its own";
    if (e.n[f] < 0) {
      if (e.label[f] == 0)
        return "a face on the outside without a label";
      continue;
    }
    const Element& beyond = m.element[e.n[f]];
    const size_t g = beyond.face_towards(t);
    const auto there = outward_triangle(beyond.v, g), here = outward_triangle(e.v, f);
    if (beyond.n[g] != t || !std::is_permutation(here.begin(), here.end(), there.begin()))
      return "a neighbour that is none";
    if (e.label[f] != beyond.label[g] || (e.label[f] != 0) != (e.region != beyond.region))
      return "a wrong label";
  }
  return nullptr;
}

} // namespace

std::string find_fault(const Region& r) {
  for (int32_t t = 0; t < static_cast<int32_t>(r.mesh.element.size()); ++t)
    if (r.mesh.element[t].alive() && r.owned(t))
      if (const char* const fault = fault_of(r.mesh, t))
        return "element " + std::to_string(t) + " has " + fault;
  return {};
}

TetMesh as_mesh(const Region& r) {
  std::vector<int32_t> owned;
  for (int32_t t = 0; t < static_cast<int32_t>(r.mesh.element.size()); ++t)
    if (r.mesh.element[t].alive() && r.owned(t))
      owned.push_back(t);
  PartCopy part = r.copy(owned);
  std::vector<uint8_t> inside(part.mesh.element.size());
  for (const int32_t t : part.slots)
    inside[t] = 1;
  for (size_t t = 0; t < inside.size(); ++t)
    if (!inside[t])
      part.mesh.element[t] = {};
  for (const int32_t t : part.slots)
    for (int32_t& n : part.mesh.element[t].n)
      if (n >= 0 && !inside[n])
        n = -1;
  std::fill(part.mesh.incident.begin(), part.mesh.incident.end(), -1);
  for (const int32_t t : part.slots)
    for (const int32_t v : part.mesh.element[t].v)
      part.mesh.incident[v] = t;
  std::fill(part.mesh.labelled.begin(), part.mesh.labelled.end(), uint8_t{1});
  return extract(part.mesh);
}

#ifdef MOLMESH_CHECK_OPERATIONS
void check_region(const Region& r, const char* operation) {
  if (const std::string fault = find_fault(r); !fault.empty())
    fail(Status::failed, std::string(operation) + ": " + fault);
}
#endif

} // namespace molmesh::optimize
