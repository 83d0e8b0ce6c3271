// limits.hpp — the largest coordinate, radius, exponent and weight of a hierarchy, and the least of the last two.
#pragma once

namespace molmesh {

/// Beyond any molecule; larger numbers would overflow what is computed from them.
inline constexpr double largest_coordinate = 1e7; ///< Å: a millimetre
inline constexpr double largest_radius = 1e4;     ///< Å
/// Of a group, and of the product of exponents of groups within each other. Below, the field hardly falls: at 1e-4
/// the band of a single atom reaches 30 Å.
inline constexpr double least_exponent = 1e-4, largest_exponent = 1e3;
inline constexpr double least_weight = 1e-3, largest_weight = 1e3;

} // namespace molmesh
