// nearest.hpp — the atom nearest to a place, and how people call where it is.
#pragma once
#include "molecule/hierarchy.hpp"

namespace molmesh {

/// Index of the atom whose sphere is nearest to p (inside: negative distance), the first of equals; looks at all.
int64_t nearest_atom(const Hierarchy& h, Vec3d p);
/// "chain A residue GLY.12": its groups, outermost first; empty without levels.
std::string groups_of(const Hierarchy& h, int64_t atom);

/// "chain A residue GLY.12 CA": the atom nearest to p.
std::string nearest_name(const Hierarchy& h, Vec3d p);

} // namespace molmesh
