// relax.hpp — vertices off the surface and the walls move to where the worst element round them is best.
#pragma once
#include "contour/elements.hpp"

namespace molmesh::contour {

/// Moves vertices of elements with dihedral angles under 13° or over 160°. Surface and walls stay, so that inside
/// and outside alike come out the same alone and together. No vertex's worst element gets worse; the same result
/// for any number of threads. Returns how often a vertex moved.
int64_t relax(Elements& elements, int threads);

} // namespace molmesh::contour
