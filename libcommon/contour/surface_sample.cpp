// surface_sample.cpp — crossings on a fine cell's edges and the gradient at its middle.
#include "contour/surface_sample.hpp"
#include "geom/morton.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::contour {
namespace {

SurfaceSample sample(const SurfaceCell& cell, double isovalue) {
  const float* v = cell.value;
  Vec3d sum, gradient;
  int crossings = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 8; ++c) {
      const int d = c | 1 << axis;
      if (d == c)
        continue;
      gradient[axis] += double(v[d]) - v[c];
      if ((v[c] > isovalue) == (v[d] > isovalue))
        continue;
      Vec3d p{double(c & 1), double(c >> 1 & 1), double(c >> 2)};
      p[axis] = crossing_share(v[c], v[d], isovalue);
      sum += p;
      ++crossings;
    }
  const double length = norm(gradient);
  return {to_double(morton_point(cell.key)) + sum / double(crossings), length > 0 ? gradient / length : Vec3d{}};
}

} // namespace

std::vector<SurfaceSample> surface_samples(const std::vector<SurfaceCell>& cells, float isovalue, int threads) {
  std::vector<SurfaceSample> samples(cells.size());
  par::for_n(static_cast<int64_t>(cells.size()), threads, [&](int64_t i) {
    samples[static_cast<size_t>(i)] = sample(cells[static_cast<size_t>(i)], double(isovalue));
  });
  return samples;
}

} // namespace molmesh::contour
