// surface_sample.hpp — where the surface passes through a fine cell, and which way it faces.
#pragma once
#include "contour/surface_cells.hpp"
#include "geom/log.hpp"
#include "geom/vec.hpp"

namespace molmesh::contour {

/// Surface of one fine cell: the mean of its crossings with the cell's edges (the paper's mass centre), in lattice
/// coordinates, and the unit gradient of G, inwards; zero where it vanishes.
struct SurfaceSample {
  Vec3d point, normal;
};

/// Crossing of the surface with the straight line between two neighbouring values, as a share of the way from a to
/// b: log G is interpolated, since G falls exponentially. Kept away from both ends. log_a: of a / isovalue
HD inline double crossing_share(double a, double b, double log_a, double log_b, double isovalue) {
  const bool logarithmic = a > 0 && b > 0;
  const double fa = logarithmic ? log_a : a - isovalue, fb = logarithmic ? log_b : b - isovalue,
               share = fa == fb ? 0.5 : fa / (fa - fb);
  constexpr double least = 0.02; // of an edge between its end and a crossing
  return share < least ? least : share > 1 - least ? 1 - least : share;
}
HD inline double crossing_share(double a, double b, double isovalue) {
  const bool logarithmic = a > 0 && b > 0;
  return crossing_share(a, b, logarithmic ? portable_log(a / isovalue) : 0,
                        logarithmic ? portable_log(b / isovalue) : 0, isovalue);
}

} // namespace molmesh::contour
