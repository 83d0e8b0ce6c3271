// relax.hpp — vertices off the surface and the walls move to where the worst element round them is best.
#pragma once
#include "contour/elements.hpp"

namespace molmesh::contour {

/// Moves vertices of elements with dihedral angles under 13° or over 160°. Surface and walls stay, so that inside
/// and outside alike come out the same alone and together. No vertex's worst element gets worse; the same result
/// for any number of threads. Returns how often a vertex moved.
/// lattice_class: Complex::lattice_classes; the lattice's own elements need no look. Empty: all are looked at.
int64_t relax(Elements& elements, const std::vector<uint8_t>& lattice_class, int threads);

} // namespace molmesh::contour
