// samples_simd.hpp — samples of eight surface cells, vectorized for the best instruction set of this machine.
#pragma once
#include "contour/surface/surface_cell.hpp"

namespace molmesh::contour {

/// As sample_cells of each, to the last bit: [axis][cell].
struct alignas(64) EightSamples {
  double point[3][8], gradient[3][8];
};
void make_samples(const SurfaceCell (&cell)[8], double isovalue, EightSamples& samples);

} // namespace molmesh::contour
