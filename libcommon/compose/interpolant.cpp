// interpolant.cpp — sums the normal equations of ten coefficients and solves them.
#include "compose/interpolant.hpp"
#include "base/log.hpp"
#include "par/pages.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace molmesh::compose {
namespace {

constexpr int terms = 10; // 1, x, y, z, xx, yy, zz, xy, xz, yz

/// The upper triangle of a symmetric matrix and a right side, solved by Cholesky's method.
struct Equations {
  double a[terms][terms] = {}, b[terms] = {};

  void add(Vec3d d, double weight, double f) {
    const double t[terms] = {1, d.x, d.y, d.z, d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.x * d.z, d.y * d.z};
    for (int i = 0; i < terms; ++i) {
      const double w = weight * t[i];
      b[i] += w * f;
      for (int j = i; j < terms; ++j)
        a[i][j] += w * t[j];
    }
  }
  /// The first n unknowns, in b. False: the matrix is not positive.
  bool solve(int n) {
    for (int i = 0; i < n; ++i) {
      double d = a[i][i];
      for (int k = 0; k < i; ++k)
        d -= a[k][i] * a[k][i];
      if (!(d > 1e-12 * a[0][0]))
        return false;
      a[i][i] = std::sqrt(d);
      for (int j = i + 1; j < n; ++j) {
        double s = a[i][j];
        for (int k = 0; k < i; ++k)
          s -= a[k][i] * a[k][j];
        a[i][j] = s / a[i][i];
      }
    }
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < i; ++k)
        b[i] -= a[k][i] * b[k];
      b[i] /= a[i][i];
    }
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k)
        b[i] -= a[i][k] * b[k];
      b[i] /= a[i][i];
    }
    return true;
  }
};

} // namespace

Interpolant::Interpolant(const BlockGrid& grid, int threads) : grid_(grid), index_(grid) {
  par::resize_pages(log_, grid.value.size(), threads);
  par::for_n(static_cast<int64_t>(grid.corner.size()), threads, 64, [&](int64_t b) {
    for (int s = 0; s < 512; ++s) {
      const bool active = grid.active[8 * b + (s >> 6)] >> (s & 63) & 1;
      const double g = std::max<double>(grid.value[512 * b + s], 1e-30);
      log_[512 * b + s] = active ? static_cast<float>(portable_log(g / grid.info.isovalue))
                                 : std::numeric_limits<float>::quiet_NaN();
    }
  });
}

int Interpolant::side(Vec3i cell) const {
  int in = 0;
  for (int k = 0; k < 8; ++k)
    in += inside(cell + Vec3i{k >> 2, k >> 1 & 1, k & 1});
  return in == 8 ? 1 : in == 0 ? -1 : 0;
}

bool Interpolant::whole(Vec3i cell) const {
  for (int k = 0; k < 8; ++k)
    if (!is_active(grid_, index_, cell + Vec3i{k >> 2, k >> 1 & 1, k & 1}))
      return false;
  return true;
}

bool Interpolant::fit(Vec3d u, Value& value) const {
  constexpr double reach = 3; // spacings
  const Vec3i c{static_cast<int32_t>(std::floor(u.x)), static_cast<int32_t>(std::floor(u.y)),
                static_cast<int32_t>(std::floor(u.z))};
  const Vec3i first = c - Vec3i{2, 2, 2}, home = block_corner(first);
  int64_t block[8]; // six points lie in two blocks at most
  bool any = false;
  for (int k = 0; k < 8; ++k) {
    block[k] = index_.find(first + Vec3i{k >> 2 ? 5 : 0, k >> 1 & 1 ? 5 : 0, k & 1 ? 5 : 0});
    any = any || block[k] >= 0;
  }
  if (!any)
    return false;
  Equations q;
  bool near = false;
  int64_t count = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const Vec3i row = first + Vec3i{i, j, 0};
      const int across = (row.x - home.x >= 8 ? 4 : 0) + (row.y - home.y >= 8 ? 2 : 0);
      for (int k = 0; k < 6; ++k) {
        const Vec3i p = row + Vec3i{0, 0, k};
        const int64_t b = block[across + (p.z - home.z >= 8 ? 1 : 0)];
        if (b < 0)
          continue;
        const double f = log_[512 * b + slot(p)];
        if (!(f == f))
          continue;
        near = near || (i >= 1 && i <= 4 && j >= 1 && j <= 4 && k >= 1 && k <= 4);
        const Vec3d d = to_double(p) - u;
        const double r2 = norm2(d);
        if (r2 >= reach * reach)
          continue;
        const double hat = 1 - r2 / (reach * reach);
        q.add(d, hat * hat / ((r2 + 0.02) * (1 + f * f)), f);
        ++count;
      }
    }
  if (!near)
    return false;
  // Where two layers of points are nearly all there is, little tells how the field bends across them: it is then
  // taken to be nearly straight.
  constexpr double ridge = 0.02;
  Equations linear = q;
  for (int i = 4; i < terms; ++i)
    q.a[i][i] += ridge;
  const Equations* solved = nullptr;
  if (count >= terms && q.solve(terms))
    solved = &q;
  else if (linear.solve(4))
    solved = &linear;
  if (!solved)
    return false;
  value = {solved->b[0], {solved->b[1], solved->b[2], solved->b[3]}};
  double least = 1e300, most = -1e300; // of the cell's corners: no farther than these
  bool all = true;
  for (int k = 0; k < 8; ++k) {
    const Vec3i p = c + Vec3i{k >> 2, k >> 1 & 1, k & 1};
    const int64_t b = index_.find(p);
    const double f = b >= 0 ? log_[512 * b + slot(p)] : std::numeric_limits<double>::quiet_NaN();
    all = all && f == f;
    least = std::min(least, f);
    most = std::max(most, f);
  }
  if (all)
    value.f = std::clamp(value.f, least, most);
  return std::isfinite(value.f);
}

} // namespace molmesh::compose
