// cutoff.hpp — the distance beyond which a cluster of atoms may be ignored.
// Equation 7 of Liao et al. 2013 (R_kd) holds for one atom and one plain sum. Here all ignored clusters together
// change G by at most Field::far_error, for any depth and exponents (docs/theory/field.md §3).
#pragma once
#include "density/field/field.hpp"

namespace molmesh::density {

/// Per level, innermost first, and group: ln of an upper bound on the group's sum anywhere; last that of G.
std::vector<std::vector<double>> largest_sums(const Field& f);

/// Sets cutoff2 of all clusters from far_error; the rest of the field is complete.
void set_cutoffs(Field& f);

} // namespace molmesh::density
