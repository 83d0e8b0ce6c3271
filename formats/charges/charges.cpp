// charges.cpp — lists charges, then the mesh's point nearest to each.
#include "formats/charges/charges.hpp"
#include "formats/text_out.hpp"
#include "mesh/nearest_points.hpp"

namespace molmesh::formats {

int64_t write_charges(std::ostream& out, const Hierarchy& h, const TetMesh& m) {
  std::vector<const Atom*> charged;
  std::vector<Vec3d> place;
  for (const Atom& a : h.atom)
    if (a.charge < 0 || a.charge > 0) // NaN: not given
      charged.push_back(&a), place.push_back(a.center);
  TextOut text(out);
  text << charged.size() << '\n';
  for (const Atom* const a : charged)
    text << a->center.x << ' ' << a->center.y << ' ' << a->center.z << ' ' << a->charge << ' ' << a->radius << '\n';
  for (const NearestPoint& n : nearest_points(m, place))
    text << n.point << ' ' << n.distance << '\n';
  return static_cast<int64_t>(charged.size());
}

} // namespace molmesh::formats
