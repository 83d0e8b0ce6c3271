// push_off.hpp — surface points leave the isosurface, as rounds leave some.
#pragma once
#include "isosurface/isosurface.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"

namespace molmesh::test {

/// Every 20th point of that kind goes 0.05 h to 0.2 h along the normal, or what of it is in its wall: elements good
/// enough to solve on stay positive. Returns how many.
inline int push_off(optimize::DynamicMesh& m, const Isosurface& surface,
                    optimize::Kind kind = optimize::Kind::surface) {
  const double h = surface.spacing();
  std::vector<uint8_t> pushed(m.point.size());
  int count = 0;
  for (size_t v = 0; v < m.point.size(); ++v) {
    double distance;
    Vec3d normal;
    if (m.vertex[v].kind != kind || v % 20 != 0 || !surface.probe(m.point[v], distance, normal))
      continue;
    if (kind == optimize::Kind::trace)
      normal[m.vertex[v].axis()] = 0;
    m.point[v] += h * (0.05 + 0.01 * double(v % 16)) * (v % 40 == 0 ? 1. : -1.) * normal;
    pushed[v] = 1;
    ++count;
  }
  for (size_t e = 0; e < m.element.size(); ++e) {
    optimize::Element& element = m.element[e];
    for (const int32_t v : element.v)
      if (element.alive() && pushed[v]) {
        element.q = m.quality(element.v);
        m.note_change(static_cast<int32_t>(e));
        break;
      }
  }
  return count;
}

} // namespace molmesh::test
