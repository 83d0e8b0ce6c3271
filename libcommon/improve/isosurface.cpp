// isosurface.cpp — trilinear log G, and Newton's steps along its gradient.
#include "improve/isosurface.hpp"
#include "par/par.hpp"
#include <cmath>
#include <limits>

namespace molmesh::improve {

Isosurface::Isosurface(const BlockGrid& grid, int threads)
    : frame_(grid.frame), index_(grid), log_(grid.value.size()) {
  const double iso = grid.info.isovalue;
  par::for_n(static_cast<int64_t>(grid.active.size()), threads, 64, [&](int64_t w) {
    const uint64_t bits = grid.active[static_cast<size_t>(w)];
    for (int b = 0; b < 64; ++b) {
      const size_t s = static_cast<size_t>(64 * w + b);
      log_[s] = bits >> b & 1 && grid.value[s] > 0 ? static_cast<float>(std::log(grid.value[s] / iso))
                                                   : std::numeric_limits<float>::quiet_NaN();
    }
  });
}

bool Isosurface::evaluate(Vec3d p, double& f, Vec3d& gradient) const {
  const Vec3d u = (p - frame_.origin) / frame_.spacing;
  if (!(std::abs(u.x) < 1e9 && std::abs(u.y) < 1e9 && std::abs(u.z) < 1e9))
    return false;
  const Vec3i c{static_cast<int32_t>(std::floor(u.x)), static_cast<int32_t>(std::floor(u.y)),
                static_cast<int32_t>(std::floor(u.z))};
  double v[8];
  if ((c.x & 7) < 7 && (c.y & 7) < 7 && (c.z & 7) < 7) {
    const int64_t b = index_.find(c);
    if (b < 0)
      return false;
    const float* q = &log_[static_cast<size_t>(512 * b + slot(c))];
    for (int k = 0; k < 8; ++k)
      v[k] = q[64 * (k >> 2) + 8 * (k >> 1 & 1) + (k & 1)];
  } else {
    for (int k = 0; k < 8; ++k) {
      const Vec3i corner = c + Vec3i{k >> 2, k >> 1 & 1, k & 1};
      const int64_t b = index_.find(corner);
      if (b < 0)
        return false;
      v[k] = log_[static_cast<size_t>(512 * b + slot(corner))];
    }
  }
  const Vec3d t = u - to_double(c);
  const double z0 = v[0] + t.z * (v[1] - v[0]), z1 = v[2] + t.z * (v[3] - v[2]);
  const double z2 = v[4] + t.z * (v[5] - v[4]), z3 = v[6] + t.z * (v[7] - v[6]);
  const double y0 = z0 + t.y * (z1 - z0), y1 = z2 + t.y * (z3 - z2);
  f = y0 + t.x * (y1 - y0);
  const double d0 = (v[1] - v[0]) + t.y * ((v[3] - v[2]) - (v[1] - v[0]));
  const double d1 = (v[5] - v[4]) + t.y * ((v[7] - v[6]) - (v[5] - v[4]));
  gradient = Vec3d{y1 - y0, (z1 - z0) + t.x * ((z3 - z2) - (z1 - z0)), d0 + t.x * (d1 - d0)} / frame_.spacing;
  return std::isfinite(f); // NaN when a corner is not active
}

bool Isosurface::probe(Vec3d p, double& distance, Vec3d& normal) const {
  double f;
  Vec3d g;
  if (!evaluate(p, f, g))
    return false;
  const double length = norm(g);
  if (!(length > 0))
    return false;
  distance = -f / length - offset_;
  normal = g / -length;
  return true;
}

bool Isosurface::project(Vec3d& p, double reach) const {
  const Vec3d from = p;
  double distance;
  Vec3d normal;
  for (int step = 0; step < 8; ++step) {
    if (!probe(p, distance, normal))
      return false;
    if (std::abs(distance) < 1e-3 * frame_.spacing)
      return norm2(p - from) <= reach * reach;
    if (std::abs(distance) > reach)
      return false;
    p += -distance * normal;
  }
  return false;
}

} // namespace molmesh::improve
