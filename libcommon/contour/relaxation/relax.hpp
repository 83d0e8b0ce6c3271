// relax.hpp — relaxation: vertices of the worst elements move to where these are best.
#pragma once
#include "contour/elements/elements.hpp"
#include "isosurface/target.hpp"

namespace molmesh::contour {

/// [vertices of the complex] as LatticeClasses says.
LargeArray<uint8_t> lattice_classes(const Complex& complex, int threads);

/// Moves vertices of elements with dihedral angles under 13° or over 160°, or Q under 0.10: walls stay plane, those
/// on the surface within a share of the grid spacing of `surface` (or no farther than they are); without it they
/// stay. No vertex's worst element gets worse, where elements on the side that is not meshed count
/// as unmeshed_weight says; all stay positive by the exact predicate; the same result for any number of threads.
/// Then corners of surface triangles whose centroids are over 0.49 grid spacings from the surface move nearer: for
/// that elements may fall to these limits, or to the star's worst where that is beyond.
/// Returns how often a vertex moved. lattice_class: lattice_classes of the complex; the lattice's own elements need
/// no look. Empty: all are judged, on both sides.
int64_t relax(Elements& elements, const LargeArray<uint8_t>& lattice_class, const Target* surface, int threads);

} // namespace molmesh::contour
