// bodies.hpp — the part of a hierarchy that makes the density: without atoms of radius 0.
#pragma once
#include "molecule/hierarchy.hpp"

namespace molmesh {

/// False where an atom of radius 0 is a charge without a body.
bool all_have_bodies(const Hierarchy& h);

struct Bodies {
  Hierarchy hierarchy; ///< without atoms of radius 0, and without the groups that are then empty
  std::vector<std::vector<int64_t>> index; ///< [level; last the atoms][entry] that group's or atom's index before
};

Bodies bodies_of(const Hierarchy& h);

} // namespace molmesh
