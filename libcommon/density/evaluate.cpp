// evaluate.cpp — separable sums per unit, powers, sums of the groups above.
#include "density/evaluate.hpp"
#include "density/block_kernel.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace molmesh::density {
namespace {

/// Numbers too small for the usual form count as 0 while this lives: they matter nowhere and are slow.
class FlushSubnormals {
#ifdef __SSE2__
public:
  FlushSubnormals() {
    _mm_setcsr(before_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
  }
  ~FlushSubnormals() {
    _mm_setcsr(before_);
  }
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;

private:
  const unsigned before_ = _mm_getcsr();
#endif
};

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int edge = 8, points = 512;

/// start·ratio^i for the eight points of an axis.
void geometric(double start, double ratio, double* out) {
  for (int i = 0; i < edge; ++i, start *= ratio)
    out[i] = start;
}

/// T of a unit at every point.
void sum_atoms(const Selection& s, const Unit& u, double decay, double h, double* T) {
  std::fill_n(T, points, 0.0);
  double ex[edge], ey[edge], ez[edge], eyz[edge * edge];
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
void add_power(const Unit& u, double decay, Vec3d middle, double h, const double* T, double* sum) {
  double q[3][edge], qyz[64], eyz[64];
  double widest = std::abs(u.exponent * u.ln_center);
  for (int axis = 0; axis < 3; ++axis) {
    quadratic(u, decay, middle, h, axis, q[axis]);
    for (const double v : q[axis])
      widest = std::max(widest, std::abs(v));
  }
  const bool separable = widest < 200; // then no factor leaves what a double holds
  for (double& v : q[0])
    v += u.exponent * u.ln_center;
  for (int j = 0; j < edge; ++j)
    for (int k = 0; k < edge; ++k) {
      qyz[8 * j + k] = q[1][j] + q[2][k];
      eyz[8 * j + k] = separable ? std::exp(qyz[8 * j + k]) : 0;
    }
  const auto p = u.exponent;
  for (int i = 0; i < edge; ++i) {
    const double ex = separable ? std::exp(q[0][i]) : 0;
    double* const to = sum + 64 * i;
    const double* const t = T + 64 * i;
    if (separable && p == 1)
      for (int jk = 0; jk < 64; ++jk)
        to[jk] += ex * eyz[jk] * t[jk];
    else if (separable && p == 0.5)
      for (int jk = 0; jk < 64; ++jk)
        to[jk] += ex * eyz[jk] * std::sqrt(t[jk]);
    else
      for (int jk = 0; jk < 64; ++jk)
        to[jk] += std::exp(q[0][i] + qyz[jk] + p * std::log(t[jk]));
  }
}

} // namespace

void Evaluator::in_single(const Field& f, const Selection& s, double h, float* out) {
  constexpr double log2e = std::numbers::log2e;
  [[maybe_unused]] const FlushSubnormals flush;
  const BlockUnits& u = s.block_units;
  const double step = 2 * f.decay * h * log2e;
  BlockShape shape{{}, static_cast<float>(step), static_cast<float>(-0.5 * step * h)};
  std::copy_n(s.box.middle, 3, shape.middle);
  const auto rows = static_cast<size_t>(s.atoms + s.units);
  rows_.x.resize(std::max(rows_.x.size(), 8 * rows));
  rows_.yz.resize(std::max(rows_.yz.size(), 64 * rows));
  rows_.scale.resize(std::max(rows_.scale.size(), static_cast<size_t>(s.units) + 16));
  make_rows(u, shape, rows_);
  const auto start = static_cast<float>(s.added);
  OpenGroups groups(f);
  if (groups.levels() == 1) {
    sum_units(u, rows_, start, out);
  } else {
    std::fill_n(out, points, start);
    single_.assign(groups.levels() * points, 0.0f); // [l]: the open group of level l
    const auto sum_of = [&](size_t l) { return l < groups.levels() ? &single_[l * points] : out; };
    const auto close = [&](size_t l, int64_t g) {
      raise_group(static_cast<float>(f.level[l].exponent[static_cast<size_t>(g)]), sum_of(l), sum_of(l + 1));
    };
    for (int32_t n = 0; n < u.n; ++n) {
      groups.enter(s.group_of(n), close);
      add_units(u, rows_, n, n + 1, sum_of(1));
    }
    groups.finish(close);
  }
}

void Evaluator::in_double(const Field& f, const Selection& s, Vec3d middle, double h, float* out) {
  OpenGroups groups(f);
  double_.assign((groups.levels() + 1) * points, 0.0); // [0]: G, [l]: the open group of level l, last: T
  double* const T = &double_[groups.levels() * points];
  const auto close = [&](size_t l, int64_t g) {
    const double p = f.level[l].exponent[static_cast<size_t>(g)];
    double* const from = &double_[l * points];
    double* const to = l + 1 < groups.levels() ? from + points : double_.data();
    for (int i = 0; i < points; ++i)
      to[i] += p == 1 ? from[i] : std::pow(from[i], p);
    std::fill_n(from, points, 0.0);
  };
  for (const Unit& u : s.unit) {
    groups.enter(u.group, close);
    sum_atoms(s, u, f.decay, h, T);
    add_power(u, f.decay, middle, h, T, groups.levels() > 1 ? &double_[points] : double_.data());
  }
  groups.finish(close);
  for (int i = 0; i < points; ++i)
    out[i] = static_cast<float>(double_[static_cast<size_t>(i)] + s.added);
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
    out[point] = static_cast<float>(std::exp(open[0]) + s.added);
  }
}

void Evaluator::evaluate(const Field& f, const Selection& s, Vec3d middle, double h, float* out) {
  switch (s.arithmetic) {
  case Arithmetic::in_single:
    return in_single(f, s, h, out);
  case Arithmetic::in_double:
    return in_double(f, s, middle, h, out);
  case Arithmetic::in_logarithms:
    return by_logarithms(f, s, middle, h, out);
  }
}

} // namespace molmesh::density
