// isosurface_view.hpp — log G on plain arrays: value, distance and projection at a point. Host and device.
#pragma once
#include "base/lanes.hpp"
#include "grid/block_grid.hpp"
#include <cmath>

namespace molmesh {

/// Of values v at the corners of a cell, z fastest, at t of the way through it: the trilinear value, and its
/// gradient where the cell is `edge` wide.
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void
trilinear(const V& tx, const V& ty, const V& tz, const V (&v)[8], double edge, V& value, V (&gradient)[3]) {
  const V z0 = v[0] + tz * (v[1] - v[0]), z1 = v[2] + tz * (v[3] - v[2]);
  const V z2 = v[4] + tz * (v[5] - v[4]), z3 = v[6] + tz * (v[7] - v[6]);
  const V y0 = z0 + ty * (z1 - z0), y1 = z2 + ty * (z3 - z2);
  value = y0 + tx * (y1 - y0);
  const V d0 = (v[1] - v[0]) + ty * ((v[3] - v[2]) - (v[1] - v[0]));
  const V d1 = (v[5] - v[4]) + ty * ((v[7] - v[6]) - (v[5] - v[4]));
  gradient[0] = (y1 - y0) / edge;
  gradient[1] = ((z1 - z0) + tx * ((z3 - z2) - (z1 - z0))) / edge;
  gradient[2] = (d0 + tx * (d1 - d0)) / edge;
}

/// To first order, from log G / isovalue and its gradient of that length, which is positive.
template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void
to_distance(const V& f, const V (&gradient)[3], const V& length, double offset, V& distance, V (&normal)[3]) {
  distance = -f / length - offset;
  for (int a = 0; a < 3; ++a)
    normal[a] = gradient[a] / -length;
}

/// How far outside the isosurface points may be kept, in spacings, so that chords enclose its own volume.
inline constexpr double most_offset = 0.0175;

/// log G / isovalue, trilinear in each known cell: its eight corners are active.
struct IsosurfaceView {
  GridFrame frame;
  BlockIndexView index;
  const float* log;  ///< [512 n], NaN where not active
  double offset = 0; ///< Å: how far outside the isosurface points are kept

  MOLMESH_HD double spacing() const { return frame.spacing; }

  /// f = log(G / isovalue) and its gradient (1/Å); outside the known cells by the next one, a quarter of a cell
  /// far. False beyond.
  MOLMESH_HD bool evaluate(Vec3d p, double& f, Vec3d& gradient) const {
    Vec3d u;
    Vec3i c;
    if (!locate(p, u, c))
      return false;
    double v[8];
    if (!values(c, v) && !values_beside(u, c, v))
      return false;
    interpolate(u, c, v, f, gradient);
    return true;
  }

  /// u: p in spacings; c: the lower corner of its cell. False beyond all grids.
  MOLMESH_HD bool locate(Vec3d p, Vec3d& u, Vec3i& c) const {
    u = (p - frame.origin) / frame.spacing;
    return cell_of(u, c);
  }
  MOLMESH_HD bool cell_of(Vec3d u, Vec3i& c) const {
    if (!(std::abs(u.x) < 1e9 && std::abs(u.y) < 1e9 && std::abs(u.z) < 1e9))
      return false;
    c = {lower(u.x), lower(u.y), lower(u.z)};
    return true;
  }
  /// As evaluate, at u by the cell at c with the corners' values v.
  MOLMESH_HD void interpolate(Vec3d u, Vec3i c, const double (&v)[8], double& f, Vec3d& gradient) const {
    const Vec3d t = u - to_double(c);
    double g[3];
    trilinear(t.x, t.y, t.z, v, frame.spacing, f, g);
    gradient = {g[0], g[1], g[2]};
  }

  MOLMESH_HD bool probe(Vec3d p, double& distance, Vec3d& normal) const {
    double f;
    Vec3d g;
    return evaluate(p, f, g) && to_distance(f, g, distance, normal);
  }
  MOLMESH_HD bool to_distance(double f, Vec3d g, double& distance, Vec3d& normal) const {
    const double length = norm(g), gradient[3] = {g.x, g.y, g.z};
    if (!(length > 0))
      return false;
    double n[3];
    molmesh::to_distance(f, gradient, length, offset, distance, n);
    normal = {n[0], n[1], n[2]};
    return true;
  }

  MOLMESH_HD bool project(Vec3d& p, double reach) const {
    const Vec3d from = p;
    double f, distance, v[8];
    Vec3d u, gradient, normal;
    Vec3i c, known;
    bool whole = false; // the values at v are those of the cell there: most steps stay in it
    for (int step = 0; step < 8; ++step) {
      if (!locate(p, u, c))
        return false;
      if (!whole || !(c == known)) {
        known = c;
        whole = values(c, v);
        if (!whole && !values_beside(u, c, v))
          return false;
      }
      interpolate(u, c, v, f, gradient);
      if (!to_distance(f, gradient, distance, normal))
        return false;
      if (std::abs(distance) < 1e-3 * frame.spacing)
        return norm2(p - from) <= reach * reach;
      if (std::abs(distance) > reach)
        return false;
      p += -distance * normal;
    }
    return false;
  }

  /// At the corners of the cell at c, z fastest. False where one is not active.
  MOLMESH_HD bool values(Vec3i c, double (&v)[8]) const {
    BlockIndexView::Last last;
    return values(c, v, last);
  }
  /// T: float, as they are kept, or double. last: where many cells near each other are asked for.
  template <class T>
  MOLMESH_HD bool values(Vec3i c, T (&v)[8], BlockIndexView::Last& last) const {
    T sum = 0; // NaN when one is
    if ((c.x & 7) < 7 && (c.y & 7) < 7 && (c.z & 7) < 7) {
      const int64_t b = index.find(c, last);
      if (b < 0)
        return false;
      const float* q = log + (512 * b + slot(c));
      for (int k = 0; k < 8; ++k)
        sum += v[k] = q[64 * (k >> 2) + 8 * (k >> 1 & 1) + (k & 1)];
    } else {
      const int across = ((c.x & 7) == 7) << 2 | ((c.y & 7) == 7) << 1 | ((c.z & 7) == 7);
      int64_t block[8]; // of the first corner in it: others differ in axes that stay inside
      for (int k = 0; k < 8; ++k) {
        const Vec3i corner = c + Vec3i{k >> 2, k >> 1 & 1, k & 1};
        if ((k & across) == k && (block[k] = index.find(corner)) < 0)
          return false;
        sum += v[k] = log[512 * block[k & across] + slot(corner)];
      }
    }
    return std::isfinite(sum);
  }

private:
  /// std::floor, which is a call where a processor may be without the instruction.
  MOLMESH_HD static int32_t lower(double x) {
    const auto towards_zero = static_cast<int32_t>(x);
    return towards_zero - (x < towards_zero);
  }
  /// Of the known cell behind the nearest face, whose corner c becomes: where the isosurface touches a grid point,
  /// a point may come to lie in a cell that it does not cross.
  MOLMESH_HD bool values_beside(Vec3d u, Vec3i& c, double (&v)[8]) const {
    const Vec3i home = c;
    double best = 0.25;
    for (int a = 0; a < 3; ++a) {
      const double t = u[a] - home[a], far = t < 0.5 ? t : 1 - t;
      Vec3i beside = home;
      beside[a] += t < 0.5 ? -1 : 1;
      double w[8];
      if (far < best && values(beside, w)) {
        best = far;
        c = beside;
        for (int k = 0; k < 8; ++k)
          v[k] = w[k];
      }
    }
    return best < 0.25;
  }
};

} // namespace molmesh
