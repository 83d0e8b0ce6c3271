// selection.cpp — bounds over a block, groups and atoms dropped within the budget.
#include "density/selection.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A sum on its way to the root: an upper bound over the block, value and gradient of its logarithm at the middle.
struct Fold {
  double upper = -infinity, middle = -infinity;
  Vec3d gradient{};
  void add(const Fold& term) {
    upper = log_add(upper, term.upper);
    const double sum = log_add(middle, term.middle);
    if (sum > -infinity)
      gradient = std::exp(middle - sum) * gradient + std::exp(term.middle - sum) * term.gradient;
    middle = sum;
  }
  Fold raised(double p) const { return {p * upper, p * middle, p * gradient}; }
};

} // namespace

void Selection::gather(const Field& f, Vec3d middle, Vec3d half, std::span<const int32_t> clusters) {
  const Box block{middle - half, middle + half};
  candidate_.clear();
  atom_.clear();
  ln_upper_.clear();
  ln_middle_.clear();
  for (const int32_t cluster : clusters) {
    const auto c = static_cast<size_t>(cluster);
    if (distance2(block, f.box[c]) >= f.cutoff2[c])
      continue;
    const double p = f.level[0].exponent[static_cast<size_t>(f.group[c])];
    const auto first = static_cast<int32_t>(atom_.size());
    if (candidate_.empty() || p == 1 || candidate_.back().group != f.group[c])
      candidate_.push_back({f.group[c], p, first, first, -infinity, -infinity, {}, 0, true});
    for (int64_t a = f.begin[c]; a < f.begin[c + 1]; ++a) {
      const auto s = static_cast<size_t>(a);
      double near2 = 0, middle2 = 0;
      const double d[3] = {std::abs(f.x[s] - middle.x), std::abs(f.y[s] - middle.y), std::abs(f.z[s] - middle.z)};
      for (int axis = 0; axis < 3; ++axis) {
        const double n = std::max(0.0, d[axis] - half[axis]);
        near2 += n * n;
        middle2 += d[axis] * d[axis];
      }
      atom_.push_back(a);
      ln_upper_.push_back(f.peak[s] - f.decay * near2);
      ln_middle_.push_back(f.peak[s] - f.decay * middle2);
    }
    candidate_.back().end = static_cast<int32_t>(atom_.size());
  }
  for (Candidate& c : candidate_) {
    const auto begin = static_cast<size_t>(c.begin), end = static_cast<size_t>(c.end);
    const double top_upper = *std::max_element(&ln_upper_[begin], &ln_upper_[0] + end);
    const double top = *std::max_element(&ln_middle_[begin], &ln_middle_[0] + end);
    double upper = 0, sum = 0;
    Vec3d moment{};
    for (size_t i = begin; i < end; ++i) {
      const auto s = static_cast<size_t>(atom_[i]);
      const double w = std::exp(ln_middle_[i] - top);
      upper += std::exp(ln_upper_[i] - top_upper);
      sum += w;
      moment += w * Vec3d{f.x[s], f.y[s], f.z[s]};
    }
    c.ln_upper = top_upper + std::log(upper);
    c.ln_middle = top + std::log(sum);
    c.centroid = moment / sum;
  }
}

void Selection::find_effects(const Field& f) {
  for (Candidate& c : candidate_)
    c.ln_effect = c.exponent * c.ln_upper;
  if (f.plain_above)
    return;
  // Upper bounds of the sums of all open groups, as runs per level; run_[l] counts them on both passes.
  sum_.resize(f.level.size());
  for (std::vector<double>& s : sum_)
    s.clear();
  std::vector<double> open(f.level.size(), -infinity);
  OpenGroups up(f);
  const auto close_sum = [&](size_t l, int64_t g) {
    sum_[l].push_back(open[l]);
    if (l + 1 < open.size())
      open[l + 1] = log_add(open[l + 1], f.level[l].exponent[static_cast<size_t>(g)] * open[l]);
    open[l] = -infinity;
  };
  for (const Candidate& c : candidate_) {
    up.enter(c.group, close_sum);
    open[1] = log_add(open[1], c.ln_effect);
  }
  up.finish(close_sum);

  std::vector<size_t> run(f.level.size(), 0);
  OpenGroups again(f);
  const auto count = [&](size_t l, int64_t) { ++run[l]; };
  for (Candidate& c : candidate_) {
    again.enter(c.group, count);
    int64_t g = c.group;
    for (size_t l = 1; l < f.level.size(); ++l) {
      g = f.level[l - 1].parent[static_cast<size_t>(g)];
      const double p = f.level[l].exponent[static_cast<size_t>(g)];
      c.ln_effect = p <= 1 ? p * c.ln_effect : c.ln_effect + std::log(p) + (p - 1) * sum_[l][run[l]];
    }
  }
}

/// Drops the candidates with the smallest effects while their sum stays within the budget; returns the sum.
double Selection::drop(double budget) {
  order_.resize(candidate_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [&](int32_t a, int32_t b) {
    const double ea = candidate_[static_cast<size_t>(a)].ln_effect,
                 eb = candidate_[static_cast<size_t>(b)].ln_effect;
    return ea != eb ? ea < eb : a < b;
  });
  double spent = 0;
  for (const int32_t i : order_) {
    Candidate& c = candidate_[static_cast<size_t>(i)];
    const double effect = std::exp(c.ln_effect);
    if (spent + effect > budget)
      break;
    spent += effect;
    c.kept = false;
  }
  return spent;
}

void Selection::keep_atoms(const Field& f, const Candidate& c, Vec3d half, double within) {
  // T(x) ≥ 1, so atoms whose terms of T together stay below η are at most η of the sum.
  const double ln_small = std::log(within / static_cast<double>(c.end - c.begin));
  Unit u{c.group, c.exponent, static_cast<int32_t>(ln_weight.size()), 0, c.ln_middle, c.centroid};
  for (auto i = static_cast<size_t>(c.begin); i < static_cast<size_t>(c.end); ++i) {
    const auto s = static_cast<size_t>(atom_[i]);
    const Vec3d offset = Vec3d{f.x[s], f.y[s], f.z[s]} - c.centroid;
    const double swing =
        2 * f.decay * (half.x * std::abs(offset.x) + half.y * std::abs(offset.y) + half.z * std::abs(offset.z));
    const double ln_w = ln_middle_[i] - c.ln_middle;
    if (ln_w + swing < ln_small)
      continue;
    range = std::max(range, swing);
    ln_weight.push_back(ln_w);
    offset_x.push_back(offset.x);
    offset_y.push_back(offset.y);
    offset_z.push_back(offset.z);
  }
  u.end = static_cast<int32_t>(ln_weight.size());
  unit.push_back(u);
}

void Selection::select(const Field& f, Vec3d middle, Vec3d half, std::span<const int32_t> clusters,
                       const Budget& budget, bool classify, double lower, double upper) {
  side = Side::mixed;
  unit.clear();
  ln_weight.clear();
  offset_x.clear();
  offset_y.clear();
  offset_z.clear();
  range = 0;
  gather(f, middle, half, clusters);
  find_effects(f);
  if (classify) {
    OpenGroups groups(f);
    std::vector<Fold> open(groups.levels());
    Fold root;
    const auto close = [&](size_t l, int64_t g) {
      (l + 1 < open.size() ? open[l + 1] : root).add(open[l].raised(f.level[l].exponent[static_cast<size_t>(g)]));
      open[l] = Fold{};
    };
    for (const Candidate& c : candidate_) {
      groups.enter(c.group, close);
      const Fold term{c.ln_upper, c.ln_middle, 2 * f.decay * (c.centroid - middle)};
      (open.size() > 1 ? open[1] : root).add(term.raised(c.exponent));
    }
    groups.finish(close);
    const double total =
        budget.far + budget.block + budget.within; // twice over: values are compared after dropping
    if (std::exp(root.upper) + 2 * total < lower) {
      side = Side::outside;
      return;
    }
    // ln G + κQ|δ|² is convex, so it lies above its tangent at the middle (field.md §5).
    const Vec3d g = root.gradient;
    const double least = root.middle - (std::abs(g.x) * half.x + std::abs(g.y) * half.y + std::abs(g.z) * half.z) -
                         f.decay * f.steepest * norm2(half);
    if (std::exp(least) * (1 - 4 * total) > upper + 4 * total) {
      side = Side::inside;
      return;
    }
  }
  drop(budget.block);
  for (const Candidate& c : candidate_)
    if (c.kept)
      keep_atoms(f, c, half, std::min(0.1, budget.within / (1.1 * f.steepest)));
}

} // namespace molmesh::density
