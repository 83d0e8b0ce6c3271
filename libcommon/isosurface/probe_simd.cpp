// probe_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "isosurface/probe_simd.hpp"
#include "isosurface/guard.hpp"
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "isosurface/probe_simd.cpp"
#include <hwy/foreach_target.h>

#include "geom/double_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh {
namespace HWY_NAMESPACE {
namespace {

using namespace molmesh::HWY_NAMESPACE;

/// Values at the corners of eight cells, corner k of cell i at value[k][i], and the cells' lower corners.
struct Cells {
  HWY_ALIGN float value[8][8] = {};
  EightPlaces corner;

  /// False where the cell at c is not known.
  HWY_INLINE bool set(const IsosurfaceView& s, size_t i, Vec3i c, BlockIndexView::Last& last) {
    float v[8];
    if (!s.values(c, v, last))
      return false;
    corner.set(i, to_double(c));
    for (size_t k = 0; k < 8; ++k)
      value[k][i] = v[k];
    return true;
  }
};

/// Of places in spacings, in their cells.
struct Probed {
  HWY_ALIGN double length[8]; ///< of the gradient
  EightProbes at;             ///< but for `known`

  HWY_INLINE void set(const IsosurfaceView& s, const EightPlaces& u, const Cells& cells) {
    for (int l = 0; l < 8; l += lanes) {
      V x, y, z, cx, cy, cz, v[8], value, g[3], root, distance, normal[3];
      load(u.x + l, x), load(u.y + l, y), load(u.z + l, z);
      load(cells.corner.x + l, cx), load(cells.corner.y + l, cy), load(cells.corner.z + l, cz);
      for (int k = 0; k < 8; ++k) {
        const hn::Rebind<float, F> single;
        hn::Store(hn::PromoteTo(f, hn::LoadU(single, cells.value[k] + l)), f, reinterpret_cast<double*>(&v[k]));
      }
      trilinear(x - cx, y - cy, z - cz, v, s.frame.spacing, value, g);
      squared_length(g, root);
      take_root(root);
      to_distance(value, g, root, s.offset, distance, normal);
      store(root, length + l);
      store(distance, at.distance + l);
      store(normal[0], at.normal.x + l), store(normal[1], at.normal.y + l), store(normal[2], at.normal.z + l);
    }
  }
};

HWY_INLINE void to_spacings(const GridFrame& frame, const EightPlaces& p, EightPlaces& u) {
  const double* const from[3] = {p.x, p.y, p.z};
  double* const to[3] = {u.x, u.y, u.z};
  for (int a = 0; a < 3; ++a)
    for (int l = 0; l < 8; l += lanes) {
      V v;
      load(from[a] + l, v);
      store((v - frame.origin[a]) / frame.spacing, to[a] + l);
    }
}

void probe_eight_simd(const IsosurfaceView& s, const EightPlaces& p, int n, EightProbes& out) {
  EightPlaces u;
  to_spacings(s.frame, p, u);
  Cells cells;
  BlockIndexView::Last last;
  uint32_t in_cell = 0;
  for (size_t i = 0; i < static_cast<size_t>(n); ++i)
    if (Vec3i c; s.cell_of(u[i], c) && cells.set(s, i, c, last))
      in_cell |= 1u << i;
  Probed probed;
  probed.set(s, u, cells);
  out = probed.at;
  out.known = 0;
  for (size_t i = 0; i < static_cast<size_t>(n); ++i)
    if (in_cell >> i & 1) {
      out.known |= uint32_t{probed.length[i] > 0} << i;
    } else if (Vec3d normal; s.probe(p[i], out.distance[i], normal)) { // by the cell beside
      out.normal.set(i, normal);
      out.known |= 1u << i;
    }
}

uint32_t project_eight_simd(const IsosurfaceView& s, EightPlaces& p, int n, double reach) {
  const EightPlaces from = p;
  Cells cells;
  BlockIndexView::Last last;
  Vec3i known[8];
  uint32_t on_surface = 0, in_cell = 0, left = (1u << n) - 1;
  const auto for_left = [&](auto&& visit) {
    for (uint32_t bits = left; bits; bits &= bits - 1)
      visit(static_cast<size_t>(std::countr_zero(bits)));
  };
  for (int step = 0; step < 8 && left; ++step) {
    EightPlaces u;
    to_spacings(s.frame, p, u);
    for_left([&](size_t i) {
      const uint32_t bit = 1u << i;
      Vec3i c;
      if (!s.cell_of(u[i], c)) {
        left &= ~bit;
      } else if (!(in_cell & bit) || !(c == known[i])) { // most steps stay in their cell
        known[i] = c;
        in_cell |= bit;
        if (!cells.set(s, i, c, last)) { // by the cell beside
          Vec3d q = from[i];
          on_surface |= s.project(q, reach) ? bit : 0;
          p.set(i, q);
          left &= ~bit;
        }
      }
    });
    Probed probed;
    probed.set(s, u, cells);
    for_left([&](size_t i) {
      const uint32_t bit = 1u << i;
      const double distance = probed.at.distance[i], off = std::abs(distance);
      if (probed.length[i] > 0 && !(off < 1e-3 * s.frame.spacing) && !(off > reach)) {
        p.set(i, p[i] + -distance * probed.at.normal[i]);
        return;
      }
      left &= ~bit;
      if (probed.length[i] > 0 && off < 1e-3 * s.frame.spacing && norm2(p[i] - from[i]) <= reach * reach)
        on_surface |= bit;
    });
  }
  return on_surface;
}

void centroids_simd(const EightTriangles& t, EightPlaces& out) {
  const auto mean = [](const double* a, const double* b, const double* c, double* to) {
    for (int l = 0; l < 8; l += lanes) {
      V p, q, r;
      load(a + l, p), load(b + l, q), load(c + l, r);
      store((p + q + r) / 3., to + l);
    }
  };
  mean(t.a.x, t.b.x, t.c.x, out.x);
  mean(t.a.y, t.b.y, t.c.y, out.y);
  mean(t.a.z, t.b.z, t.c.z, out.z);
}

void misfits_simd(const EightTriangles& t, const EightProbes& at, double far, double most_tilt, double (&out)[8]) {
  for (int l = 0; l < 8; l += lanes) {
    V a[3], b[3], c[3], n[3], length, normal[3], distance, misfit;
    const auto corner = [&](const EightPlaces& p, V(&to)[3]) {
      load(p.x + l, to[0]), load(p.y + l, to[1]), load(p.z + l, to[2]);
    };
    corner(t.a, a), corner(t.b, b), corner(t.c, c), corner(at.normal, normal);
    load(at.distance + l, distance);
    V u[3], v[3];
    for (int axis = 0; axis < 3; ++axis)
      u[axis] = b[axis] - a[axis], v[axis] = c[axis] - a[axis];
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
    squared_length(n, length);
    take_root(length);
    misfit_at(n, length, distance, normal, far, most_tilt, misfit);
    store(misfit, out + l);
  }
  for (size_t i = 0; i < 8; ++i)
    if (!at.is_known(i))
      out[i] = unknown_misfit;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh {

HWY_EXPORT(probe_eight_simd);
HWY_EXPORT(project_eight_simd);
HWY_EXPORT(centroids_simd);
HWY_EXPORT(misfits_simd);

void probe_eight(const IsosurfaceView& surface, const EightPlaces& p, int n, EightProbes& out) {
  HWY_DYNAMIC_DISPATCH(probe_eight_simd)(surface, p, n, out);
}
uint32_t project_eight(const IsosurfaceView& surface, EightPlaces& p, int n, double reach) {
  return HWY_DYNAMIC_DISPATCH(project_eight_simd)(surface, p, n, reach);
}
void centroids(const EightTriangles& t, EightPlaces& out) {
  HWY_DYNAMIC_DISPATCH(centroids_simd)(t, out);
}
void misfits(const EightTriangles& t, const EightProbes& at, double far, double most_tilt, double (&out)[8]) {
  HWY_DYNAMIC_DISPATCH(misfits_simd)(t, at, far, most_tilt, out);
}

} // namespace molmesh
#endif
