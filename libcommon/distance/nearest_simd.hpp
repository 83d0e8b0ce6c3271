// nearest_simd.hpp — depth of many points in a ball, and their squared distances to an arc or a vertex; vectorized
// for the best instruction set of this machine, with the same bits on each.
#pragma once
#include "distance/boundary.hpp"
#include <cstddef>

namespace molmesh::distance {

/// Points as arrays of coordinates, whose length is a multiple of 8; aligned to 64 bytes, as all arrays here.
struct Points {
  const double *x, *y, *z;
  size_t n;
};

/// Where the points are deeper in the ball than `depth` says, sets depth and `deepest` (to the ball's number);
/// second: the next smaller depth. Returns the smallest depth then.
double take_deeper(const Points& p, const Ball& ball, double number, double* depth, double* second,
                   double* deepest);

/// d2: becomes the squared distance to the arc where its circle's nearest place lies on it and that is less.
/// Returns the largest d2 then.
double take_nearer(const Points& p, const Arc& arc, double* d2);
/// The same with a vertex.
double take_nearer(const Points& p, Vec3d vertex, double* d2);

} // namespace molmesh::distance
