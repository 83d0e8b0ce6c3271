// evaluate.cpp — separable sums per unit, powers, sums of the groups above.
#include "density/evaluate.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int edge = 8, points = 512;

/// start·ratio^i for the eight points of an axis.
template <class Real>
void geometric(double start, double ratio, Real* out) {
  for (int i = 0; i < edge; ++i, start *= ratio)
    out[i] = static_cast<Real>(start);
}

/// T of a unit at every point.
template <class Real>
void sum_atoms(const Selection& s, const Unit& u, double decay, double h, Real* T) {
  std::fill_n(T, points, Real(0));
  Real ex[edge], ey[edge], ez[edge], eyz[edge * edge];
  for (auto a = static_cast<size_t>(u.begin); a < static_cast<size_t>(u.end); ++a) {
    const double step = 2 * decay * h;
    const double tx = step * s.offset_x[a], ty = step * s.offset_y[a], tz = step * s.offset_z[a];
    geometric(std::exp(s.ln_weight[a] - 3.5 * tx), std::exp(tx), ex);
    geometric(std::exp(-3.5 * ty), std::exp(ty), ey);
    geometric(std::exp(-3.5 * tz), std::exp(tz), ez);
    for (int j = 0; j < edge; ++j)
      for (int k = 0; k < edge; ++k)
        eyz[8 * j + k] = ey[j] * ez[k];
    for (int i = 0; i < edge; ++i)
      for (int jk = 0; jk < 64; ++jk)
        T[64 * i + jk] += ex[i] * eyz[jk];
  }
}

/// ln of what T is multiplied with in S, at point i of an axis; times P.
void quadratic(const Unit& u, double decay, Vec3d middle, double h, int axis, double* q) {
  for (int i = 0; i < edge; ++i) {
    const double d = (i - 3.5) * h;
    q[i] = -u.exponent * decay * (2 * d * (middle[axis] - u.centroid[axis]) + d * d);
  }
}

/// sum += (S)^P at every point.
template <class Real>
void add_unit(const Unit& u, double decay, Vec3d middle, double h, const Real* T, Real* sum) {
  double qx[edge], qy[edge], qz[edge];
  Real qyz[64];
  quadratic(u, decay, middle, h, 0, qx);
  quadratic(u, decay, middle, h, 1, qy);
  quadratic(u, decay, middle, h, 2, qz);
  for (int j = 0; j < edge; ++j)
    for (int k = 0; k < edge; ++k)
      qyz[8 * j + k] = static_cast<Real>(qy[j] + qz[k]);
  const auto p = static_cast<Real>(u.exponent);
  for (int i = 0; i < edge; ++i) {
    const auto q = static_cast<Real>(qx[i] + u.exponent * u.ln_center);
    for (int jk = 0; jk < 64; ++jk) {
      const Real t = T[64 * i + jk];
      const Real e = q + qyz[jk];
      sum[64 * i + jk] += p == 1           ? std::exp(e) * t
                          : p == Real(0.5) ? std::exp(e) * std::sqrt(t)
                                           : std::exp(e + p * std::log(t));
    }
  }
}

} // namespace

Arithmetic arithmetic_for(const Field& f, double tolerance) {
  // The smallest term of a group above the innermost level that can matter, as cutoffs see it.
  const bool coarse = tolerance >= 2e-5 * std::max(1.0, f.steepest);
  if (f.plain_above)
    return coarse ? Arithmetic::single : Arithmetic::twice;
  double least = 0;
  for (size_t c = 0; c < f.group.size(); ++c) {
    const double p = f.level[0].exponent[static_cast<size_t>(f.group[c])];
    least = std::min(least, p * (f.ln_peak[c] - f.decay * f.cutoff2[c]));
  }
  constexpr double margin = 10;
  if (least < -700 + margin)
    return Arithmetic::logarithm;
  return least < -87 + margin || !coarse ? Arithmetic::twice : Arithmetic::single;
}

template <class Real>
void Evaluator::direct(const Field& f, const Selection& s, Vec3d middle, double h, float* out) {
  OpenGroups groups(f);
  std::vector<Real>& sums = [this]() -> std::vector<Real>& {
    if constexpr (sizeof(Real) == sizeof(float))
      return single_;
    else
      return twice_;
  }();
  sums.assign((groups.levels() + 1) * points, Real(0)); // [0]: G, [l]: the open group of level l, last: T
  Real* const T = &sums[groups.levels() * points];
  const auto close = [&](size_t l, int64_t g) {
    const auto p = static_cast<Real>(f.level[l].exponent[static_cast<size_t>(g)]);
    Real* const from = &sums[l * points];
    Real* const to = l + 1 < groups.levels() ? from + points : sums.data();
    for (int i = 0; i < points; ++i)
      to[i] += p == 1 ? from[i] : std::pow(from[i], p);
    std::fill_n(from, points, Real(0));
  };
  for (const Unit& u : s.unit) {
    groups.enter(u.group, close);
    sum_atoms(s, u, f.decay, h, T);
    add_unit(u, f.decay, middle, h, T, groups.levels() > 1 ? &sums[points] : sums.data());
  }
  groups.finish(close);
  for (int i = 0; i < points; ++i)
    out[i] = static_cast<float>(sums[static_cast<size_t>(i)]);
}

void Evaluator::by_logarithms(const Field& f, const Selection& s, Vec3d middle, double h, float* out) {
  OpenGroups groups(f);
  std::vector<double> open(groups.levels());
  for (int point = 0; point < points; ++point) {
    const Vec3d d = h * Vec3d{(point >> 6) - 3.5, (point >> 3 & 7) - 3.5, (point & 7) - 3.5};
    std::fill(open.begin(), open.end(), -infinity);
    const auto close = [&](size_t l, int64_t g) {
      double& to = l + 1 < open.size() ? open[l + 1] : open[0];
      to = log_add(to, f.level[l].exponent[static_cast<size_t>(g)] * open[l]);
      open[l] = -infinity;
    };
    for (const Unit& u : s.unit) {
      groups.enter(u.group, close);
      double top = -infinity, sum = 0;
      const auto term = [&](size_t a) {
        return s.ln_weight[a] + 2 * f.decay * (d.x * s.offset_x[a] + d.y * s.offset_y[a] + d.z * s.offset_z[a]);
      };
      for (auto a = static_cast<size_t>(u.begin); a < static_cast<size_t>(u.end); ++a)
        top = std::max(top, term(a));
      for (auto a = static_cast<size_t>(u.begin); a < static_cast<size_t>(u.end); ++a)
        sum += std::exp(term(a) - top);
      const double ln_sum =
          top + std::log(sum) + u.ln_center - f.decay * (2 * dot(d, middle - u.centroid) + norm2(d));
      double& to = open.size() > 1 ? open[1] : open[0];
      to = log_add(to, u.exponent * ln_sum);
    }
    groups.finish(close);
    out[point] = static_cast<float>(std::exp(open[0]));
  }
}

void Evaluator::evaluate(const Field& f, const Selection& s, Vec3d middle, double h, Arithmetic arithmetic,
                         float* out) {
  // T itself must not overflow: coarse grids, steep kernels.
  if (arithmetic == Arithmetic::single && s.range > 80)
    arithmetic = Arithmetic::twice;
  if (arithmetic == Arithmetic::twice && s.range > 690)
    arithmetic = Arithmetic::logarithm;
  switch (arithmetic) {
  case Arithmetic::single:
    return direct<float>(f, s, middle, h, out);
  case Arithmetic::twice:
    return direct<double>(f, s, middle, h, out);
  case Arithmetic::logarithm:
    return by_logarithms(f, s, middle, h, out);
  }
}

} // namespace molmesh::density
