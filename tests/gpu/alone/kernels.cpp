// kernels.cpp — what libcommon vectorizes with Highway, one element after the other: for a build by nvcc alone.
#include "contour/samples_kernel.hpp"
#include "contour/surface_sample.hpp"
#include "improve/quality.hpp"
#include "improve/quality_kernel.hpp"
#include "improve/spokes_kernel.hpp"
#include <algorithm>
#include <bit>

namespace molmesh::improve {
namespace {

float judge(const SpokesView& s, int32_t k, Vec3f x) {
  float field[SpokeGroup::fields], q;
  for (int i = 0; i < SpokeGroup::fields; ++i)
    field[i] = s.group[k / SpokeGroup::lanes].field[i][k % SpokeGroup::lanes];
  spoke_quality(std::bit_cast<Spoke<float>>(field), x.x, x.y, x.z, q, s.shape);
  return q;
}

} // namespace

float worst_spoke(const SpokesView& s, Vec3f x, float) {
  float worst = 2;
  for (int32_t k = 0; k < s.count; ++k)
    worst = std::min(worst, judge(s, k, x));
  return worst;
}

void judge_spokes(const SpokesView& s, Vec3f x, float* quality) {
  for (int32_t k = 0; k < s.count; ++k)
    quality[k] = judge(s, k, x);
}

void judge_around(const SpokesView& s, int32_t spoke, Vec3f x, float d, float (&out)[6]) {
  for (int k = 0; k < 6; ++k) {
    Vec3f y = x;
    y[k / 2] = k % 2 ? y[k / 2] - d : y[k / 2] + d;
    out[k] = judge(s, spoke, y);
  }
}

int first_place_above(const SpokesView& s, const Places& places, int from, int n, float above, float& q) {
  for (int k = from; k < n; ++k)
    if (q = worst_spoke(s, {places.x[k], places.y[k], places.z[k]}, above); q > above)
      return k;
  return n;
}

void qualities(const EightElements& e, float (&quality)[8], double shape) {
  for (int l = 0; l < 8; ++l)
    quality[l] = tet_quality({e.x[0][l], e.y[0][l], e.z[0][l]}, {e.x[1][l], e.y[1][l], e.z[1][l]},
                             {e.x[2][l], e.y[2][l], e.z[2][l]}, {e.x[3][l], e.y[3][l], e.z[3][l]}, shape);
}

} // namespace molmesh::improve

namespace molmesh::contour {

void make_samples(const SurfaceCell (&cell)[8], double isovalue, EightSamples& samples) {
  for (int n = 0; n < 8; ++n) {
    double v[8], point[3], gradient[3];
    for (int c = 0; c < 8; ++c)
      v[c] = cell[n].value[c];
    sample_cells<double, uint64_t>(v, isovalue, point, gradient);
    for (int a = 0; a < 3; ++a) {
      samples.point[a][n] = point[a];
      samples.gradient[a][n] = gradient[a];
    }
  }
}

} // namespace molmesh::contour
