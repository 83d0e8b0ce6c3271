// nearest.cpp — a walk over all atoms, and one down the levels.
#include "molecule/nearest.hpp"
#include <algorithm>

namespace molmesh {

int64_t nearest_atom(const Hierarchy& h, Vec3d p) {
  int64_t nearest = -1;
  double best = 0;
  for (size_t a = 0; a < h.atom.size(); ++a) {
    const double d = norm(p - h.atom[a].center) - h.atom[a].radius;
    if (nearest < 0 || d < best)
      best = d, nearest = static_cast<int64_t>(a);
  }
  return nearest;
}

std::string groups_of(const Hierarchy& h, int64_t atom) {
  std::string text;
  int64_t index = atom;
  for (size_t l = h.level.size(); l-- > 0;) {
    const std::vector<Group>& group = h.level[l].group;
    const auto g =
        std::upper_bound(group.begin(), group.end(), index, [](int64_t i, const Group& x) { return i < x.end; });
    text = h.level[l].name + ' ' + g->name + (text.empty() ? "" : " ") + text;
    index = g - group.begin();
  }
  return text;
}

std::string nearest_name(const Hierarchy& h, Vec3d p) {
  const int64_t atom = nearest_atom(h, p);
  return groups_of(h, atom) + ' ' + h.names[h.atom[atom].name];
}

} // namespace molmesh
