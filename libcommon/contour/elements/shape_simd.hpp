// shape_simd.hpp — the least sines of eight elements' dihedral angles, vectorized for the best instruction set of
// this machine.
#pragma once
#include "base/lanes.hpp"
#include "geom/tet_quality_simd.hpp"

namespace molmesh::contour {

/// Of elements, one or one in each lane: V is double, or one of the compiler's vectors. By reference: what vectors
/// look like as arguments depends on the processor.
template <class V>
struct Sines {
  V length[10]; ///< of the edges 01 02 03 12 13 23 and of the normals opposite the corners; squared until rooted
  V six_volume;
};
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void set_edge(const Corners<V>& p, int from, int to, V (&e)[3]) {
  e[0] = p.x[to] - p.x[from];
  e[1] = p.y[to] - p.y[from];
  e[2] = p.z[to] - p.z[from];
}
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void set_normal(const V (&a)[3], const V (&b)[3], V (&n)[3]) {
  n[0] = a[1] * b[2] - a[2] * b[1];
  n[1] = a[2] * b[0] - a[0] * b[2];
  n[2] = a[0] * b[1] - a[1] * b[0];
}
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void begin_sines(const Corners<V>& p, Sines<V>& s) {
  V e[6][3], n[4][3];
  set_edge(p, 0, 1, e[0]), set_edge(p, 0, 2, e[1]), set_edge(p, 0, 3, e[2]);
  set_edge(p, 1, 2, e[3]), set_edge(p, 1, 3, e[4]), set_edge(p, 2, 3, e[5]);
  set_normal(e[3], e[4], n[0]), set_normal(e[2], e[1], n[1]);
  set_normal(e[0], e[2], n[2]), set_normal(e[1], e[0], n[3]);
  for (int k = 0; k < 10; ++k) {
    const V(&v)[3] = k < 6 ? e[k] : n[k - 6];
    squared_length(v, s.length[k]);
  }
  s.six_volume = -(n[3][0] * e[2][0] + n[3][1] * e[2][1] + n[3][2] * e[2][2]);
}
/// least: of the dihedral angles; -1 where the volume is not positive. The sine at the edge between two faces is
/// six volumes times the edge over both normals, twice their areas long.
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void least_of(const Sines<V>& s, V& least) {
  V inverse[4];
  for (int f = 0; f < 4; ++f)
    inverse[f] = 1 / s.length[6 + f];
  least = s.six_volume * s.length[0] * (inverse[2] * inverse[3]);
  for (int e = 1; e < 6; ++e) {
    const int f = e < 3 ? 1 : 0, g = e == 1 || e == 3 ? 3 : e == 5 ? 1 : 2; // that meet there
    const V sine = s.six_volume * s.length[e] * (inverse[f] * inverse[g]);
    least = sine < least ? sine : least;
  }
  least = s.six_volume > 0 ? least : V{} - 1;
}

/// least_sine of each, to the last bit.
void eight_least_sines(const EightElements& e, double (&least)[8]);

} // namespace molmesh::contour
