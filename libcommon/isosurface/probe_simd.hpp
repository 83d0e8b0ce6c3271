// probe_simd.hpp — probes the isosurface at eight places, projects eight places onto it, and tells how eight
// triangles fit it; vectorized for the best instruction set of this machine.
#pragma once
#include "isosurface/isosurface_view.hpp"
#include <cstddef>
#include <cstdint>

namespace molmesh {

struct alignas(64) EightPlaces {
  double x[8] = {}, y[8] = {}, z[8] = {};

  void set(size_t i, Vec3d p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
  Vec3d operator[](size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Triangle i: (a[i], b[i], c[i]).
struct EightTriangles {
  EightPlaces a, b, c;
};

struct alignas(64) EightProbes {
  double distance[8] = {};
  EightPlaces normal;
  uint32_t known = 0; ///< bit i: the surface is known at place i; else its distance and normal are undefined

  bool is_known(size_t i) const { return known >> i & 1; }
};

/// Of what can be asked for many places: a Target, or what answers as one.
template <class Surface>
concept ProbesEight = requires(const Surface& surface, const EightPlaces& p, int n, EightProbes& out) {
  surface.probe_eight(p, n, out);
};

/// The first n places one by one, where nothing does it faster. Surface: probe() and project() as in Target.
template <class Surface>
void probe_each(const Surface& surface, const EightPlaces& p, int n, EightProbes& out) {
  out.known = 0;
  for (size_t i = 0; i < static_cast<size_t>(n); ++i) {
    Vec3d normal;
    out.known |= uint32_t{surface.probe(p[i], out.distance[i], normal)} << i;
    out.normal.set(i, normal);
  }
}
/// Bit i: place i was put on the surface.
template <class Surface>
uint32_t project_each(const Surface& surface, EightPlaces& p, int n, double reach) {
  uint32_t on_surface = 0;
  for (size_t i = 0; i < static_cast<size_t>(n); ++i) {
    Vec3d q = p[i];
    on_surface |= uint32_t{surface.project(q, reach)} << i;
    p.set(i, q);
  }
  return on_surface;
}

/// IsosurfaceView::probe at the first n places, to the last bit.
void probe_eight(const IsosurfaceView& surface, const EightPlaces& p, int n, EightProbes& out);
/// IsosurfaceView::project of the first n places, to the last bit. Bit i: it is true of place i.
uint32_t project_eight(const IsosurfaceView& surface, EightPlaces& p, int n, double reach);

/// What misfit() probes at: (a + b + c) / 3.
void centroids(const EightTriangles& t, EightPlaces& out);
/// misfit() of triangles whose centroids have been probed, to the last bit. far: Å, of a centroid that just keeps
/// the guard; most_tilt: Guard::tilt().
void misfits(const EightTriangles& t, const EightProbes& at, double far, double most_tilt, double (&out)[8]);

} // namespace molmesh
