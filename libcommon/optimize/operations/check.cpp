// check.cpp — every element of a region against its points and its neighbours.
#include "optimize/operations/check.hpp"
#include "base/error.hpp"
#include "geom/predicates.hpp" // exact sign of a volume
#include <algorithm>
#include <cmath>
#include <unordered_map>

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
  const DynamicMesh& m = r.mesh;
  TetMesh out;
  std::unordered_map<int32_t, int32_t> number;
  const auto point = [&](int32_t v) {
    const auto [at, is_new] = number.try_emplace(v, static_cast<int32_t>(out.point.size()));
    if (is_new)
      out.point.push_back(m.point[v]);
    return at->second;
  };
  for (int32_t t = 0; t < static_cast<int32_t>(m.element.size()); ++t) {
    const Element& e = m.element[t];
    if (!e.alive() || !r.owned(t))
      continue;
    out.tet.push_back({point(e.v[0]), point(e.v[1]), point(e.v[2]), point(e.v[3])});
    out.region.push_back(e.region);
    for (size_t f = 0; f < 4; ++f)
      if (e.label[f] != 0 && (m.counts_here(e, f) || !r.owned(e.n[f]))) {
        const Label& label = m.labels[e.label[f]];
        auto v = outward_triangle(e.v, f);
        if (label.reversed)
          std::swap(v[1], v[2]);
        out.tri.push_back({point(v[0]), point(v[1]), point(v[2])});
        out.boundary.push_back(label.name);
      }
  }
  return out;
}

#ifdef MOLMESH_CHECK_OPERATIONS
void check_region(const Region& r, const char* operation) {
  if (const std::string fault = find_fault(r); !fault.empty())
    fail(Status::failed, std::string(operation) + ": " + fault);
}
#endif

} // namespace molmesh::optimize
