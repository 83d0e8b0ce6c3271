// relax.hpp — vertices move to where the worst element round them is best.
#pragma once
#include "contour/elements/elements.hpp"
#include "isosurface/target.hpp"

namespace molmesh::contour {

/// Moves vertices of elements with dihedral angles under 13° or over 160°, or Q under 0.10: walls stay plane, those
/// on the surface within a share of the grid spacing of `surface` (or no farther than they are); without it they
/// stay. No vertex's worst element gets worse, where elements that nobody asks for count as detail::unasked_weight
/// has it; all stay positive by the exact predicate; the same result for any number of threads. Then corners of
/// surface triangles whose centroids are over 0.49 grid spacings from the surface move nearer: for that elements
/// may fall to these limits, or to the star's worst where that is beyond. Where that is not enough surface edges
/// are divided: elements, triangles and vertices come to be more, each new one behind the others. Returns how often
/// a vertex moved. lattice_class: lattice_classes of the complex; the lattice's own elements need no look. Empty:
/// all are looked at, and asked for.
int64_t relax(Elements& elements, const LargeArray<uint8_t>& lattice_class, const Target* surface, int threads);

} // namespace molmesh::contour
