// block_bounds.cpp — bounds G over a block from its units, up the levels (docs/theory/field.md §3 and §5).
#include "density/culling/block_atoms.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double log2e = std::numbers::log2e, ln2 = std::numbers::ln2;

/// A sum on its way to the root: value and gradient of its logarithm at the block's middle.
struct Fold {
  double middle = -infinity;
  Vec3d gradient{};
  void add(const Fold& term) {
    const double sum = log_add(middle, term.middle);
    if (sum > -infinity)
      gradient = std::exp(middle - sum) * gradient + std::exp(term.middle - sum) * term.gradient;
    middle = sum;
  }
  Fold raised(double p) const { return {p * middle, p * gradient}; }
};

} // namespace

/// Where the units of near_ end that are in the same group of the level around the innermost as unit `begin`.
int32_t BlockAtoms::run_end(int32_t begin) const {
  const std::vector<int64_t>& parent = f_.level[0].parent;
  int32_t end = begin + 1;
  while (end < near_.n && parent[near_.group[end]] == parent[near_.group[begin]])
    ++end;
  return end;
}

void BlockAtoms::find_effects_of_levels() {
  const auto n = static_cast<size_t>(near_.n);
  for (size_t i = 0; i < n; ++i)
    effect_[i] = near_.exponent[i] * log2_upper_[i];
  // Upper bounds of the sums of all open groups, as runs per level; `run` counts them on the second pass.
  sum_.resize(f_.level.size());
  for (std::vector<double>& s : sum_)
    s.clear();
  std::vector<double> open(f_.level.size() + 1, -infinity); // last: G's
  OpenGroups up(f_);
  const auto close_sum = [&](size_t l, int64_t g) {
    sum_[l].push_back(open[l]);
    open[l + 1] = log_add(open[l + 1], f_.level[l].exponent[g] * open[l]);
    open[l] = -infinity;
  };
  for (int32_t i = 0, end; i < near_.n; i = end) {
    end = run_end(i);
    up.enter(near_.group[i], close_sum);
    open[1] = ln2 * log2_of_sum(effect_.data() + i, end - i);
  }
  up.finish(close_sum);
  ln_upper_ = open.back();
  std::vector<size_t> run(f_.level.size(), 0);
  OpenGroups again(f_);
  const auto count = [&](size_t l, int64_t) { ++run[l]; };
  for (size_t i = 0; i < n; ++i) {
    again.enter(near_.group[i], count);
    double e = ln2 * effect_[i];
    int64_t g = near_.group[i];
    for (size_t l = 1; l < f_.level.size(); ++l) {
      g = f_.level[l - 1].parent[g];
      const double p = f_.level[l].exponent[g];
      e = p <= 1 ? p * e : e + std::log(p) + (p - 1) * sum_[l][run[l]];
    }
    effect_[i] = static_cast<float>(log2e * e);
  }
  ones_.assign(n + 16, 1.0f);
  power_terms(effect_.data(), ones_.data(), near_.n, effect_.data());
}

/// ln G + κQ|δ|² is convex, so it lies above its tangent at the middle.
bool BlockAtoms::surely_inside(Vec3d middle, Vec3d half) {
  const double bend = f_.decay * f_.steepest * norm2(half);
  const auto decay = static_cast<float>(f_.decay);
  float sum, gradient[3];
  if (f_.plain_above) {
    if (blurred_ * double{total_effect_} <= upper_ * bent_) // so is G in the middle
      return false;
    // The largest terms alone say where the test below has no chance; a wrong guess costs time only.
    const BlockUnits& u = block_units;
    sum_of_powers(u.n, u.exponent.data(), u.log2_term.data(), u.x.data(), u.y.data(), u.z.data(), box, decay, &sum,
                  gradient);
    const float slope = std::abs(gradient[0]) * box.half[0] + std::abs(gradient[1]) * box.half[1] +
                        std::abs(gradient[2]) * box.half[2];
    const double fall = bend + 0.7 * slope / sum; // e^fall is above the series
    if (3 * sum <= upper_ * (1 + fall * (1 + fall / 2 * (1 + fall / 3 * (1 + fall / 4)))))
      return false;
  }
  for (AlignedFloats* v : {&middles_.log2_sum, &middles_.x, &middles_.y, &middles_.z})
    v->resize(static_cast<size_t>(block_units.n) + 16);
  unit_middles(block_units, box, static_cast<float>(log2e * f_.decay), middles_);
  Fold root;
  if (f_.plain_above) {
    sum_of_powers(block_units.n, block_units.exponent.data(), middles_.log2_sum.data(), middles_.x.data(),
                  middles_.y.data(), middles_.z.data(), box, decay, &sum, gradient);
    if (sum <= upper_)
      return false;
    root = {std::log(double{sum}), Vec3d{gradient[0], gradient[1], gradient[2]} / double{sum}};
  } else {
    OpenGroups groups(f_);
    std::vector<Fold> open(groups.levels());
    const auto close = [&](size_t l, int64_t g) {
      (l + 1 < open.size() ? open[l + 1] : root).add(open[l].raised(f_.level[l].exponent[g]));
      open[l] = Fold{};
    };
    for (int32_t n = 0; n < block_units.n; ++n) {
      const auto u = static_cast<size_t>(n);
      const Vec3d mean = brick_middle_ + Vec3d{middles_.x[u], middles_.y[u], middles_.z[u]};
      groups.enter(group_of(n), close);
      (open.size() > 1 ? open[1] : root)
          .add(Fold{ln2 * middles_.log2_sum[u], 2 * f_.decay * (mean - middle)}.raised(block_units.exponent[u]));
    }
    groups.finish(close);
  }
  const Vec3d g = root.gradient;
  const double least =
      root.middle - (std::abs(g.x) * half.x + std::abs(g.y) * half.y + std::abs(g.z) * half.z) - bend - blur_;
  const double total = budget_.total();
  const double rounding = single + steep_ * ulp * static_cast<double>(units + atoms);
  return std::exp(least) * (1 - 4 * total - rounding) > upper_ + 4 * total;
}

} // namespace molmesh::density
