// bodies.cpp — removes atoms of radius 0 and, from the innermost level outwards, the groups that lose all children.
#include "molecule/bodies.hpp"
#include <algorithm>

namespace molmesh {

bool all_have_bodies(const Hierarchy& h) {
  return std::all_of(h.atom.begin(), h.atom.end(), [](const Atom& a) { return a.radius > 0; });
}

int64_t atoms_with_body(const Hierarchy& h) {
  return std::count_if(h.atom.begin(), h.atom.end(), [](const Atom& a) { return a.radius > 0; });
}

bool may_be_of(const Hierarchy& h, int64_t atoms) {
  return atoms == 0 || atoms == atoms_with_body(h) || atoms == static_cast<int64_t>(h.atom.size());
}

Bodies bodies_of(const Hierarchy& h) {
  const size_t levels = h.level.size();
  Bodies b;
  b.hierarchy.source = h.source;
  b.hierarchy.names = h.names;
  b.hierarchy.level.resize(levels);
  auto body = h.body.begin();
  b.index.resize(levels + 1);
  std::vector<int64_t> before{0}; // [child] how many children before it stay
  for (size_t a = 0; a < h.atom.size(); ++a) {
    if (h.atom[a].radius > 0) {
      if (body != h.body.end() && body->atom == static_cast<int64_t>(a)) {
        b.hierarchy.body.push_back(*body++);
        b.hierarchy.body.back().atom = static_cast<int64_t>(b.hierarchy.atom.size());
      }
      b.hierarchy.atom.push_back(h.atom[a]);
      b.index[levels].push_back(static_cast<int64_t>(a));
    }
    before.push_back(static_cast<int64_t>(b.hierarchy.atom.size()));
  }
  for (size_t l = levels; l-- > 0;) {
    Level& level = b.hierarchy.level[l];
    level.name = h.level[l].name;
    std::vector<int64_t> groups_before{0};
    for (size_t g = 0; g < h.level[l].group.size(); ++g) {
      Group group = h.level[l].group[g];
      group.begin = before[group.begin];
      group.end = before[group.end];
      if (group.begin < group.end) {
        level.group.push_back(std::move(group));
        b.index[l].push_back(static_cast<int64_t>(g));
      }
      groups_before.push_back(static_cast<int64_t>(level.group.size()));
    }
    before = std::move(groups_before);
  }
  return b;
}

} // namespace molmesh
