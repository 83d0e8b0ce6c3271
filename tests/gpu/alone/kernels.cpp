// kernels.cpp — what libcommon vectorizes with Highway, one element after the other: for a build by nvcc alone.
#include "base/log.hpp"
#include "contour/elements/shape_simd.hpp"
#include "contour/surface/samples_simd.hpp"
#include "contour/surface/surface_cell.hpp"
#include "geom/star_quality_simd.hpp"
#include "geom/tet_quality.hpp"
#include "geom/tet_quality_simd.hpp"
#include "grid/pack_simd.hpp"
#include "isosurface/guard.hpp"
#include "isosurface/logs_simd.hpp"
#include "isosurface/probe_simd.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace molmesh {

int32_t pack_part(const float* packed, const uint64_t* stored, const uint64_t* active, float* out) {
  int32_t n = 0;
  for (int w = 0; w < 8; ++w)
    for (uint64_t left = stored[w]; left; left &= left - 1, ++packed)
      if (active[w] & left & -left)
        out[n++] = *packed;
  return n;
}

namespace {

float judge(const StarView& s, int32_t k, Vec3f x) {
  float field[StarElementGroup::fields], q;
  for (int i = 0; i < StarElementGroup::fields; ++i)
    field[i] = s.group[k / StarElementGroup::lanes].field[i][k % StarElementGroup::lanes];
  star_element_quality(std::bit_cast<StarElement<float>>(field), x.x, x.y, x.z, q, s.shape);
  return q;
}

} // namespace

void make_star_elements(const StarCorners& from, Vec3d origin, double inverse, StarElementGroup& to) {
  for (int l = 0; l < StarElementGroup::lanes; ++l) {
    Vec3f corner[3];
    for (int k = 0; k < StarCorners::fields; ++k)
      corner[k / 3][k % 3] = static_cast<float>((from.field[k][l] - origin[k % 3]) * inverse);
    const auto field = std::bit_cast<std::array<float, StarElementGroup::fields>>(
        make_star_element(corner[0], corner[1], corner[2]));
    for (size_t k = 0; k < field.size(); ++k)
      to.field[k][l] = field[k];
  }
}

float worst_in_star(const StarView& s, Vec3f x, float) {
  float worst = 2;
  for (int32_t k = 0; k < s.count; ++k)
    worst = std::min(worst, judge(s, k, x));
  return worst;
}

void star_qualities(const StarView& s, Vec3f x, float* quality) {
  for (int32_t k = 0; k < s.count; ++k)
    quality[k] = judge(s, k, x);
}

void judge_around(const StarView& s, int32_t star_element, Vec3f x, float d, float (&out)[6]) {
  for (int k = 0; k < 6; ++k) {
    Vec3f y = x;
    y[k / 2] = k % 2 ? y[k / 2] - d : y[k / 2] + d;
    out[k] = judge(s, star_element, y);
  }
}

int first_place_above(const StarView& s, const Places& places, int from, int n, float above, float& q) {
  for (int k = from; k < n; ++k)
    if (q = worst_in_star(s, {places.x[k], places.y[k], places.z[k]}, above); q > above)
      return k;
  return n;
}

void probe_eight(const IsosurfaceView& surface, const EightPlaces& p, int n, EightProbes& out) {
  probe_each(surface, p, n, out);
}

uint32_t project_eight(const IsosurfaceView& surface, EightPlaces& p, int n, double reach) {
  return project_each(surface, p, n, reach);
}

void centroids(const EightTriangles& t, EightPlaces& out) {
  for (size_t i = 0; i < 8; ++i)
    out.set(i, (t.a[i] + t.b[i] + t.c[i]) / 3.);
}

void misfits(const EightTriangles& t, const EightProbes& at, double far, double most_tilt, double (&out)[8]) {
  for (size_t i = 0; i < 8; ++i) {
    const Vec3d n = cross(t.b[i] - t.a[i], t.c[i] - t.a[i]), along = at.normal[i];
    const double area[3] = {n.x, n.y, n.z}, normal[3] = {along.x, along.y, along.z};
    misfit_at(area, norm(n), at.distance[i], normal, far, most_tilt, out[i]);
    if (!at.is_known(i))
      out[i] = unknown_misfit;
  }
}

void log_ratios(const float* value, uint64_t active, double isovalue, float* out) {
  for (int i = 0; i < 64; ++i)
    out[i] = active >> i & 1 && value[i] > 0 ? static_cast<float>(portable_log(value[i] / isovalue))
                                             : std::numeric_limits<float>::quiet_NaN();
}

void qualities(const EightElements& e, float (&quality)[8], double shape) {
  for (int l = 0; l < 8; ++l)
    quality[l] = tet_quality({e.x[0][l], e.y[0][l], e.z[0][l]}, {e.x[1][l], e.y[1][l], e.z[1][l]},
                             {e.x[2][l], e.y[2][l], e.z[2][l]}, {e.x[3][l], e.y[3][l], e.z[3][l]}, shape);
}

} // namespace molmesh

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

void eight_least_sines(const EightElements& e, double (&least)[8]) {
  for (size_t l = 0; l < 8; ++l) {
    Corners<double> p;
    for (size_t i = 0; i < 4; ++i)
      p.x[i] = e.x[i][l], p.y[i] = e.y[i][l], p.z[i] = e.z[i][l];
    Sines<double> sines;
    begin_sines(p, sines);
    for (double& length : sines.length)
      length = std::sqrt(length);
    least_of(sines, least[l]);
  }
}

} // namespace molmesh::contour
