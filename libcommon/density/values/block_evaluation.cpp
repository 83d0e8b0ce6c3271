// block_evaluation.cpp — sums and raises the units of a block, up the levels.
#include "density/values/block_evaluation.hpp"
#include "density/values/block_sums_simd.hpp"
#include <algorithm>
#include <cmath>
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

constexpr int points = 512;

} // namespace

/// Adds what the power of a body is above that of the atom that stands for it, in whose place it comes (field.md
/// §7).
template <class T>
void Evaluator::add_body(const Field& f, const BlockAtoms& s, const BlockAtoms::UnitBody& body, double h,
                         T* out) const {
  const FieldBody& b = f.body[body.body];
  const double p = f.level[0].exponent[f.group[b.cluster]], peak = f.ln_peak[b.cluster];
  double scale = 0; // ln of what the unit's power is multiplied with
  if (s.arithmetic == Arithmetic::in_scaled)
    scale = p * (std::numbers::ln2 * s.exact_units.log2_term[body.unit] - peak +
                 f.decay * norm2(s.block_middle - body.stand_in));
  for (int point = 0; point < points; ++point) {
    const Vec3d at = s.block_middle + h * Vec3d{(point >> 6) - 3.5, (point >> 3 & 7) - 3.5, (point & 7) - 3.5};
    const double power = p * (peak - f.decay * b.core.distance2(at)) + scale,
                 stand_in = p * (peak - f.decay * norm2(at - body.stand_in)) + scale;
    if (power > -700)
      out[point] += static_cast<T>(std::exp(power) - std::exp(stand_in));
  }
}

/// out: G from the units and their factors.
template <class T, class Units>
void Evaluator::sum(const Field& f, const BlockAtoms& s, const Units& u, const BlockShape<T>& shape, double h,
                    Scratch<T>& scratch, T* out) {
  [[maybe_unused]] const FlushSubnormals flush;
  BlockRows<T>& rows = scratch.rows;
  const auto n = static_cast<size_t>(s.atoms + s.units);
  rows.x.resize(std::max(rows.x.size(), 8 * n));
  rows.yz.resize(std::max(rows.yz.size(), 64 * n));
  rows.scale.resize(std::max(rows.scale.size(), static_cast<size_t>(s.units) + 16));
  make_rows(u, shape, rows);
  if (f.plain_above) {
    sum_units(u, rows, static_cast<T>(s.added), out);
    for (const BlockAtoms::UnitBody& body : s.unit_bodies)
      add_body(f, s, body, h, out);
    return;
  }
  std::fill_n(out, points, static_cast<T>(s.added));
  OpenGroups groups(f);
  scratch.level.assign(groups.levels() * points, 0);
  const auto sum_of = [&](size_t l) { return l < groups.levels() ? &scratch.level[l * points] : out; };
  size_t closed = 0;
  const auto close = [&](size_t l, int64_t g) {
    const double shift = s.arithmetic == Arithmetic::in_scaled ? s.group_shift[closed++] : 0;
    raise_group(static_cast<T>(f.level[l].exponent[g]), static_cast<T>(shift), sum_of(l), sum_of(l + 1));
  };
  auto body = s.unit_bodies.begin();
  for (int32_t i = 0; i < u.n; ++i) {
    groups.enter(s.group_of(i), close);
    add_units(u, rows, i, i + 1, sum_of(1));
    if (body != s.unit_bodies.end() && body->unit == i)
      add_body(f, s, *body++, h, sum_of(1));
  }
  groups.finish(close);
}

void Evaluator::in_single(const Field& f, const BlockAtoms& s, double h, float* out) {
  const double step = 2 * f.decay * h * std::numbers::log2e;
  BlockShape<float> shape{{}, static_cast<float>(step), static_cast<float>(-0.5 * step * h)};
  std::copy_n(s.box.middle, 3, shape.middle);
  sum(f, s, s.block_units, shape, h, single_, out);
}

void Evaluator::in_double(const Field& f, const BlockAtoms& s, double h, float* out) {
  const double step = 2 * f.decay * h * std::numbers::log2e;
  exact_.resize(points);
  sum(f, s, s.exact_units, BlockShape<double>{{}, step, -0.5 * step * h}, h, double_, exact_.data());
  std::copy_n(exact_.begin(), points, out);
}

/// As add_body(), of logarithms, and of the body itself.
void Evaluator::add_log_body(const Field& f, const BlockAtoms& s, const BlockAtoms::UnitBody& body, double h,
                             LogSums& to) const {
  const FieldBody& b = f.body[body.body];
  const double p = f.level[0].exponent[f.group[b.cluster]];
  for (int i = 0; i < points; ++i) {
    const int point = LogSums::slot(i);
    const Vec3d at = s.block_middle + h * Vec3d{(point >> 6) - 3.5, (point >> 3 & 7) - 3.5, (point & 7) - 3.5};
    const double term = p * std::numbers::log2e * (f.ln_peak[b.cluster] - f.decay * b.core.distance2(at)),
                 before = to.largest[i], more = std::max(before, term);
    to.parts[i] = to.parts[i] * std::exp2(before - more) + std::exp2(term - more);
    to.largest[i] = more;
  }
}

void Evaluator::by_logarithms(const Field& f, const BlockAtoms& s, double h, float* out) {
  [[maybe_unused]] const FlushSubnormals flush;
  const double step = 2 * f.decay * h * std::numbers::log2e;
  const BlockShape<double> shape{{}, step, -0.5 * step * h};
  OpenGroups groups(f);
  logs_.assign(groups.levels(), {}); // the root's first
  const auto sum_of = [&](size_t l) -> LogSums& { return logs_[l < logs_.size() ? l : 0]; };
  const auto close = [&](size_t l, int64_t g) {
    raise_log_group(f.level[l].exponent[g], sum_of(l), sum_of(l + 1));
  };
  const auto parent = [&](int32_t i) { return groups.levels() > 1 ? f.level[0].parent[s.group_of(i)] : 0; };
  auto body = s.unit_bodies.begin();
  for (int32_t i = 0, end; i < s.exact_units.n; i = end) {
    groups.enter(s.group_of(i), close);
    const int32_t next_body = body != s.unit_bodies.end() ? body->unit : s.exact_units.n;
    end = i + 1;
    if (i == next_body) {
      add_log_body(f, s, *body++, h, sum_of(1));
      continue;
    }
    while (end < next_body && parent(end) == parent(i))
      ++end;
    add_log_units(s.exact_units, shape, i, end, s.loss_by_logarithms(), log_scratch_, sum_of(1));
  }
  groups.finish(close);
  sums_of_logs(sum_of(0), s.added, out);
}

void Evaluator::evaluate(const Field& f, const BlockAtoms& s, double h, float* out) {
  switch (s.arithmetic) {
  case Arithmetic::in_single:
    return in_single(f, s, h, out);
  case Arithmetic::in_double:
  case Arithmetic::in_scaled:
    return in_double(f, s, h, out);
  case Arithmetic::in_logarithms:
    return by_logarithms(f, s, h, out);
  }
}

} // namespace molmesh::density
