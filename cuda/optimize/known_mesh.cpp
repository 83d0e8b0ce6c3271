// known_mesh.cpp — slots compared, and faces on the curved surface out of the elements' labels.
#include "cuda/optimize/known_mesh.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::cuda {
namespace {

uint8_t surface_faces(const optimize::DynamicMesh& m, const optimize::Element& e) {
  unsigned faces = 0;
  for (size_t f = 0; e.alive() && f < 4; ++f)
    if (m.counts_here(e, f) && m.labels[e.label[f]].curved())
      faces |= (m.outward(e, f) ? 1u : 17u) << f;
  return static_cast<uint8_t>(faces);
}

} // namespace

template <class Known, class AsItIs>
std::vector<uint32_t> KnownMesh::renew(std::vector<Known>& known, size_t n, const AsItIs& as_it_is) const {
  const size_t before = std::min(n, known.size());
  const auto changed = par::select<uint32_t>(static_cast<int64_t>(n), threads_, [&](int64_t i) {
    return static_cast<size_t>(i) >= before || !(known[i] == as_it_is(static_cast<size_t>(i)));
  });
  known.resize(n);
  for (const uint32_t i : changed)
    known[i] = as_it_is(i);
  return {changed.begin(), changed.end()};
}

ElementChanges KnownMesh::element_changes(const optimize::DynamicMesh& m) {
  ElementChanges c;
  c.slot = renew(element_, m.element.size(), [&](size_t i) {
    const optimize::Element& e = m.element[i];
    return Element{e.alive() ? e.v : std::array<int32_t, 4>{-1, -1, -1, -1},
                   with_surface_ ? surface_faces(m, e) : uint8_t{0}};
  });
  for (const uint32_t i : c.slot) {
    const auto& v = element_[i].v;
    c.corners.push_back({{v[0], v[1], v[2], v[3]}});
    c.faces.push_back(element_[i].faces);
  }
  return c;
}

PointChanges KnownMesh::point_changes(const optimize::DynamicMesh& m) {
  PointChanges c;
  c.slot = renew(point_, m.point.size(), [&](size_t i) { return Point{m.point[i], m.vertex[i]}; });
  for (const uint32_t i : c.slot) {
    c.at.push_back(point_[i].at);
    c.vertex.push_back(point_[i].vertex);
  }
  return c;
}

} // namespace molmesh::cuda
