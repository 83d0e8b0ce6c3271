// distance.hpp — signed distance to a molecular surface on the grid points near it: the front door of this room.
#pragma once
#include "density/density.hpp"
#include "grid/band.hpp"
#include "molecule/hierarchy.hpp"

namespace molmesh::distance {

/// The surface of the atoms as balls of their radii; of balls that are larger by the probe's radius; and of what no
/// probe can reach that touches no atom's inside. docs/theory/surfaces.md
enum class Surface { van_der_waals, solvent_accessible, solvent_excluded };

struct Body {
  Surface surface = Surface::solvent_excluded;
  double probe = 1.4; ///< Å, ≥ 0; of a van der Waals surface without effect
};

/// G = exp(d / length), d the signed distance, positive inside: the isosurface G = 1 is the surface.
inline constexpr double length = 1; ///< Å

/// As density::compute, of which it takes all options but decay, isovalue and atoms. Groups and exponents have no
/// effect, atoms of radius 0 have no body. Throws Error(failed) if no atom has a radius, the wall of a grid with
/// the caller's margin cuts the surface, or no cell reaches the band; Error(usage) if the grid is too large to
/// index.
Band compute(const Hierarchy& h, const Body& body, const density::Options& options, density::Counts& counts);

} // namespace molmesh::distance
