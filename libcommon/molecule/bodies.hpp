// bodies.hpp — the part of a hierarchy that makes the density: without atoms of radius 0.
#pragma once
#include "molecule/hierarchy.hpp"

namespace molmesh {

/// False where an atom of radius 0 is a charge without a body.
bool all_have_bodies(const Hierarchy& h);

/// Atoms of a radius > 0, bodies without atoms included: those that make a density.
int64_t atoms_with_body(const Hierarchy& h);

/// Whether a density of `atoms` may be of all these. True where their number is not known (0); charges without a
/// body may have been counted.
bool may_be_of(const Hierarchy& h, int64_t atoms);

struct Bodies {
  Hierarchy hierarchy; ///< without atoms of radius 0, and without the groups that are then empty
  std::vector<std::vector<int64_t>> index; ///< [level; last the atoms][entry] that group's or atom's index before
};

Bodies bodies_of(const Hierarchy& h);

} // namespace molmesh
