// limits.hpp — the largest coordinate, radius, exponent and weight of a hierarchy.
#pragma once

namespace molmesh {

/// Beyond any molecule; larger numbers would overflow what is computed from them.
inline constexpr double largest_coordinate = 1e7; ///< Å: a millimetre
inline constexpr double largest_radius = 1e4;     ///< Å
inline constexpr double largest_exponent = 1e3;
inline constexpr double least_weight = 1e-3, largest_weight = 1e3;

} // namespace molmesh
