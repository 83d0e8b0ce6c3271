// samples_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "contour/surface/samples_simd.hpp"
#include "contour/surface/surface_cell.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contour/surface/samples_simd.cpp"
#include <hwy/foreach_target.h>

#include "geom/double_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::contour {
namespace HWY_NAMESPACE {
namespace {

using namespace molmesh::HWY_NAMESPACE;

void make_samples_simd(const SurfaceCell (&cell)[8], double isovalue, EightSamples& samples) {
  alignas(64) double value[8][8]; // [corner][cell]
  for (int n = 0; n < 8; ++n)
    for (int c = 0; c < 8; ++c)
      value[c][n] = cell[n].value[c];
  for (int l = 0; l < 8; l += lanes) {
    V v[8], point[3], gradient[3];
    for (int c = 0; c < 8; ++c)
      load(value[c] + l, v[c]);
    sample_cells<V, U>(v, isovalue, point, gradient);
    for (int a = 0; a < 3; ++a) {
      store(point[a], samples.point[a] + l);
      store(gradient[a], samples.gradient[a] + l);
    }
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::contour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::contour {

HWY_EXPORT(make_samples_simd);

void make_samples(const SurfaceCell (&cell)[8], double isovalue, EightSamples& samples) {
  HWY_DYNAMIC_DISPATCH(make_samples_simd)(cell, isovalue, samples);
}

} // namespace molmesh::contour
#endif
