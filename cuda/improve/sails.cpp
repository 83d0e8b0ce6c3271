// sails.cpp — triangles of the curved surface out of the elements' labels.
#include "cuda/improve/flow.hpp"
#include <utility>

namespace molmesh::cuda {

std::vector<Sail> sails_of(const improve::DynamicMesh& m) {
  std::vector<Sail> sails;
  for (const improve::Element& e : m.element)
    for (size_t f = 0; e.alive() && f < 4; ++f) {
      const improve::Label& label = m.labels[e.label[f]];
      if (e.label[f] == 0 || !label.curved())
        continue;
      const bool outside = e.n[f] < 0;
      const int32_t across = outside ? 0 : m.element[static_cast<size_t>(e.n[f])].region;
      if (!outside && across < e.region)
        continue; // its other side counts it
      Sail s;
      for (int i = 0; i < 3; ++i)
        s.v[i] = e.v[static_cast<size_t>(improve::outward_face[f][static_cast<size_t>(i)])];
      const bool lower = outside || e.region < across;
      if (lower == label.reversed) // the face runs against the isosurface's normal
        std::swap(s.v[1], s.v[2]);
      sails.push_back(s);
    }
  return sails;
}

} // namespace molmesh::cuda
