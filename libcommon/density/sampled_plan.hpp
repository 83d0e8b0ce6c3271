// sampled_plan.hpp — what the density of millions of atoms will take, told from a few cubes of it.
#pragma once
#include "density/plan.hpp"
#include <optional>

namespace molmesh::density {

/// As plan(), from cubes around atoms that lie evenly in the hierarchy's order, so many that they and what reaches
/// into them hold some `atoms`; none where what is there cannot be told from cubes: bodies without atoms, great
/// balls, values beyond floats, a margin that is given, a tile, or no surface in the cubes.
std::optional<Plan> sampled_plan(const Hierarchy& hierarchy, const Options& options, int64_t atoms);

} // namespace molmesh::density
