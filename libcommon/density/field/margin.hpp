// margin.hpp — computes the margin that the surface cannot cross, and the grid around it.
#pragma once
#include "density/field/field.hpp"
#include "grid/block_grid.hpp"

namespace molmesh::density {

/// Distance from the box of all centres, Å, beyond which G < value everywhere (field.md §6). value > 0.
double sufficient_margin(const Field& f, double value);

/// Longest edge of `box` widened by `margin` on every side, Å.
double longest_edge(const Box& box, double margin);

/// The grid with spacing h (Å) over `box` widened by `margin` (Å): index (0,0,0) at its lower corner, the last
/// points at its upper corner or just beyond. Throws Error(usage) for grids past 2^29 points on an axis
/// and atoms more than 10^10 spacings from the origin.
GridFrame frame_with_spacing(const Box& box, double margin, double h);
/// The same with exactly n ≥ 2 points along the longest axis.
GridFrame frame_with_points(const Box& box, double margin, int64_t n);

} // namespace molmesh::density
