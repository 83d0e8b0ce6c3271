// selection.cpp — bounds over a block, groups and atoms dropped within the budget.
#include "density/selection.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double log2e = std::numbers::log2e, ln2 = std::numbers::ln2;
constexpr double single = 1e-3; ///< more than single precision can do to a bound, relative

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

float log2_add(float a, float b) {
  const float m = std::max(a, b);
  return m + std::log2(1 + std::exp2(std::min(a, b) - m));
}

} // namespace

void Selection::enter(Vec3d middle, std::span<const int32_t> clusters) {
  node_middle_ = middle;
  const size_t n = clusters.size(), padded = (n + 15) / 16 * 16;
  LocalClusters& l = local_;
  l.cluster.assign(clusters.begin(), clusters.end());
  for (std::vector<float>* v : {&l.lo_x, &l.lo_y, &l.lo_z, &l.hi_x, &l.hi_y, &l.hi_z, &l.cutoff2, &l.peak})
    v->assign(padded, 0);
  for (std::vector<float>* v : {&l.atom_x, &l.atom_y, &l.atom_z})
    v->assign(16 * n, 0);
  l.atom_peak.assign(16 * n, -1e30f);
  for (size_t i = 0; i < n; ++i) {
    const auto c = static_cast<size_t>(clusters[i]);
    const Vec3d lo = f_.box[c].lo - middle, hi = f_.box[c].hi - middle;
    l.lo_x[i] = static_cast<float>(lo.x), l.lo_y[i] = static_cast<float>(lo.y),
    l.lo_z[i] = static_cast<float>(lo.z);
    l.hi_x[i] = static_cast<float>(hi.x), l.hi_y[i] = static_cast<float>(hi.y),
    l.hi_z[i] = static_cast<float>(hi.z);
    l.cutoff2[i] = static_cast<float>((1 + single) * f_.cutoff2[c]);
    float peak = -1e30f;
    size_t slot = 16 * i;
    for (auto a = static_cast<size_t>(f_.begin[c]); a < static_cast<size_t>(f_.begin[c + 1]); ++a, ++slot) {
      l.atom_x[slot] = static_cast<float>(f_.x[a] - middle.x);
      l.atom_y[slot] = static_cast<float>(f_.y[a] - middle.y);
      l.atom_z[slot] = static_cast<float>(f_.z[a] - middle.z);
      l.atom_peak[slot] = static_cast<float>(log2e * f_.peak[a]);
      peak = std::max(peak, l.atom_peak[slot]);
    }
    l.peak[i] = peak;
  }
  all_.resize(n);
  std::iota(all_.begin(), all_.end(), 0);
  narrowed_.resize(n + 16);
  near_.resize(n + 16);
  upper_bound_.resize(n + 16);
}

LocalBox Selection::local(Vec3d middle, Vec3d half) const {
  LocalBox b;
  for (int a = 0; a < 3; ++a) {
    b.middle[a] = static_cast<float>(middle[a] - node_middle_[a]);
    b.half[a] = static_cast<float>(half[a]);
  }
  return b;
}

bool Selection::narrow(Vec3d middle, Vec3d half) {
  narrowed_.resize(all_.size() + 16);
  const LocalBox box = local(middle, half);
  const int32_t n = near_clusters(local_, all_.data(), static_cast<int32_t>(all_.size()), box, narrowed_.data());
  narrowed_.resize(static_cast<size_t>(n));
  near_ = narrowed_;
  gather(box);
  if (!f_.plain_above)
    return true;
  effect_.resize((candidate_.size() + 15) / 16 * 16);
  for (size_t i = 0; i < candidate_.size(); ++i)
    effect_[i] = candidate_[i].exponent * candidate_[i].log2_upper;
  exp2_all(effect_.data(), static_cast<int32_t>(effect_.size()));
  double upper = 0;
  for (size_t i = 0; i < candidate_.size(); ++i)
    upper += effect_[i];
  return (1 + single) * upper + 2 * (budget_.far + budget_.block + budget_.within) >= lower_;
}

/// Candidates and their upper bounds from the clusters in near_.
void Selection::gather(const LocalBox& box) {
  const auto n = static_cast<int32_t>(near_.size());
  upper_bound_.resize(near_.size() + 16);
  upper_bounds(local_, near_.data(), n, box, static_cast<float>(log2e * f_.decay), upper_bound_.data());
  candidate_.clear();
  for (int32_t i = 0; i < n; ++i) {
    const auto c = static_cast<size_t>(local_.cluster[static_cast<size_t>(near_[static_cast<size_t>(i)])]);
    const auto p = static_cast<float>(f_.level[0].exponent[static_cast<size_t>(f_.group[c])]);
    const float bound = upper_bound_[static_cast<size_t>(i)];
    if (candidate_.empty() || p == 1 || candidate_.back().group != f_.group[c]) {
      candidate_.push_back({f_.group[c], p, i, i + 1, bound, true});
    } else {
      candidate_.back().end = i + 1;
      candidate_.back().log2_upper = log2_add(candidate_.back().log2_upper, bound);
    }
  }
}

/// effect_: the most that dropping each candidate can change G.
void Selection::find_effects() {
  effect_.assign((candidate_.size() + 15) / 16 * 16, -200);
  for (size_t i = 0; i < candidate_.size(); ++i)
    effect_[i] = candidate_[i].exponent * candidate_[i].log2_upper;
  if (!f_.plain_above) {
    // Upper bounds of the sums of all open groups, as runs per level; `run` counts them on the second pass.
    sum_.resize(f_.level.size());
    for (std::vector<double>& s : sum_)
      s.clear();
    std::vector<double> open(f_.level.size(), -infinity);
    OpenGroups up(f_);
    const auto close_sum = [&](size_t l, int64_t g) {
      sum_[l].push_back(open[l]);
      if (l + 1 < open.size())
        open[l + 1] = log_add(open[l + 1], f_.level[l].exponent[static_cast<size_t>(g)] * open[l]);
      open[l] = -infinity;
    };
    for (size_t i = 0; i < candidate_.size(); ++i) {
      up.enter(candidate_[i].group, close_sum);
      open[1] = log_add(open[1], ln2 * effect_[i]);
    }
    up.finish(close_sum);
    std::vector<size_t> run(f_.level.size(), 0);
    OpenGroups again(f_);
    const auto count = [&](size_t l, int64_t) { ++run[l]; };
    for (size_t i = 0; i < candidate_.size(); ++i) {
      again.enter(candidate_[i].group, count);
      double e = ln2 * effect_[i];
      int64_t g = candidate_[i].group;
      for (size_t l = 1; l < f_.level.size(); ++l) {
        g = f_.level[l - 1].parent[static_cast<size_t>(g)];
        const double p = f_.level[l].exponent[static_cast<size_t>(g)];
        e = p <= 1 ? p * e : e + std::log(p) + (p - 1) * sum_[l][run[l]];
      }
      effect_[i] = static_cast<float>(log2e * e);
    }
  }
  exp2_all(effect_.data(), static_cast<int32_t>(effect_.size()));
}

/// Drops candidates of small effect while their total is within the budget: those below a threshold, the largest of
/// a few that the budget allows.
void Selection::drop() {
  const auto n = static_cast<double>(candidate_.size());
  for (const double share : {0.5, 0.2, 0.08, 0.0}) {
    const double threshold = share > 0 ? share * budget_.block : budget_.block / n;
    double total = 0;
    for (size_t i = 0; i < candidate_.size(); ++i)
      if (effect_[i] <= threshold)
        total += effect_[i];
    if (total * (1 + single) > budget_.block && share > 0)
      continue;
    for (size_t i = 0; i < candidate_.size(); ++i)
      candidate_[i].kept = effect_[i] > threshold;
    return;
  }
}

/// Units with ln S, centroid and the atoms' logarithms (in ln_weight, not yet relative) at the block's middle.
void Selection::take_middles(Vec3d middle) {
  kept_.clear();
  for (const Candidate& c : candidate_)
    if (c.kept)
      kept_.insert(kept_.end(), near_.begin() + c.begin, near_.begin() + c.end);
  const auto n = static_cast<int32_t>(kept_.size());
  for (std::vector<float>* v : {&middle_sum_, &x_, &y_, &z_})
    v->resize(kept_.size() + 16);
  middle_sums(local_, kept_.data(), n, local(middle, {0, 0, 0}), static_cast<float>(log2e * f_.decay),
              middle_sum_.data(), x_.data(), y_.data(), z_.data());
  size_t k = 0;
  for (const Candidate& c : candidate_) {
    if (!c.kept)
      continue;
    Unit u{
        c.group, f_.level[0].exponent[static_cast<size_t>(c.group)], static_cast<int32_t>(ln_weight.size()), 0, 0,
        {}};
    const auto clusters = static_cast<size_t>(c.end - c.begin);
    float top = middle_sum_[k];
    for (size_t i = k; i < k + clusters; ++i)
      top = std::max(top, middle_sum_[i]);
    double sum = 0;
    Vec3d moment{};
    for (size_t i = k; i < k + clusters; ++i) {
      const double w = clusters == 1 ? 1.0 : std::exp2(middle_sum_[i] - top);
      sum += w;
      moment += w * Vec3d{x_[i], y_[i], z_[i]};
    }
    u.ln_center = ln2 * (clusters == 1 ? top : top + std::log2(sum));
    u.centroid = node_middle_ + moment / sum;
    double largest = -infinity;
    for (size_t i = k; i < k + clusters; ++i) {
      const auto cluster = static_cast<size_t>(local_.cluster[static_cast<size_t>(kept_[i])]);
      for (auto a = static_cast<size_t>(f_.begin[cluster]); a < static_cast<size_t>(f_.begin[cluster + 1]); ++a) {
        const Vec3d d{f_.x[a] - middle.x, f_.y[a] - middle.y, f_.z[a] - middle.z};
        const double ln = f_.peak[a] - f_.decay * norm2(d);
        largest = std::max(largest, ln);
        ln_weight.push_back(ln);
        offset_x.push_back(f_.x[a]);
        offset_y.push_back(f_.y[a]);
        offset_z.push_back(f_.z[a]);
      }
    }
    k += clusters;
    u.end = static_cast<int32_t>(ln_weight.size());
    // Far from a steep cluster single precision loses all terms: then the middle is found again.
    if (largest > u.ln_center + 0.01 || largest + std::log(u.end - u.begin) < u.ln_center - 0.01) {
      double total = 0;
      Vec3d at{};
      for (auto a = static_cast<size_t>(u.begin); a < static_cast<size_t>(u.end); ++a) {
        const double w = std::exp(ln_weight[a] - largest);
        total += w;
        at += w * Vec3d{offset_x[a], offset_y[a], offset_z[a]};
      }
      u.ln_center = largest + std::log(total);
      u.centroid = at / total;
    }
    unit.push_back(u);
  }
}

/// ln G + κQ|δ|² is convex, so it lies above its tangent at the middle (field.md §5).
bool Selection::surely_inside(Vec3d middle, Vec3d half) const {
  OpenGroups groups(f_);
  std::vector<Fold> open(groups.levels());
  Fold root;
  const auto close = [&](size_t l, int64_t g) {
    (l + 1 < open.size() ? open[l + 1] : root).add(open[l].raised(f_.level[l].exponent[static_cast<size_t>(g)]));
    open[l] = Fold{};
  };
  for (const Unit& u : unit) {
    groups.enter(u.group, close);
    const Fold term{u.ln_center, 2 * f_.decay * (u.centroid - middle)};
    (open.size() > 1 ? open[1] : root).add(term.raised(u.exponent));
  }
  groups.finish(close);
  const Vec3d g = root.gradient;
  const double least = root.middle - (std::abs(g.x) * half.x + std::abs(g.y) * half.y + std::abs(g.z) * half.z) -
                       f_.decay * f_.steepest * norm2(half);
  const double total = budget_.far + budget_.block + budget_.within;
  return std::exp(least) * (1 - 4 * total - single) > upper_ + 4 * total;
}

/// Drops the atoms that are next to nothing of their unit: as T ≥ 1, those whose terms of T together stay below η
/// are at most η of the sum. Makes logarithms and positions relative to the unit's middle and centroid.
void Selection::filter(Vec3d middle, Vec3d half) {
  const double within = std::min(0.1, budget_.within / (1.1 * f_.steepest));
  size_t to = 0;
  range = 0;
  for (Unit& u : unit) {
    const double ln_small = std::log(within / (u.end - u.begin));
    const auto begin = static_cast<size_t>(u.begin), end = static_cast<size_t>(u.end);
    u.begin = static_cast<int32_t>(to);
    for (size_t a = begin; a < end; ++a) {
      const Vec3d offset = Vec3d{offset_x[a], offset_y[a], offset_z[a]} - u.centroid;
      const double swing =
          2 * f_.decay * (half.x * std::abs(offset.x) + half.y * std::abs(offset.y) + half.z * std::abs(offset.z));
      const double ln = ln_weight[a] - u.ln_center;
      ln_weight[to] = ln;
      offset_x[to] = offset.x;
      offset_y[to] = offset.y;
      offset_z[to] = offset.z;
      const bool keep = ln + swing >= ln_small;
      to += keep;
      if (keep)
        range = std::max(range, swing);
    }
    u.end = static_cast<int32_t>(to);
    const Vec3d away = middle - u.centroid;
    range =
        std::max(range, 2 * f_.decay * u.exponent *
                            (half.x * std::abs(away.x) + half.y * std::abs(away.y) + half.z * std::abs(away.z)));
  }
  for (std::vector<double>* v : {&ln_weight, &offset_x, &offset_y, &offset_z})
    v->resize(to);
}

void Selection::select(Vec3d middle, Vec3d half, bool classify) {
  side = Side::mixed;
  unit.clear();
  for (std::vector<double>* v : {&ln_weight, &offset_x, &offset_y, &offset_z})
    v->clear();
  const LocalBox box = local(middle, half);
  near_.resize(narrowed_.size() + 16);
  near_.resize(static_cast<size_t>(
      near_clusters(local_, narrowed_.data(), static_cast<int32_t>(narrowed_.size()), box, near_.data())));
  gather(box);
  find_effects();
  if (classify && f_.plain_above) {
    double upper = 0;
    for (size_t i = 0; i < candidate_.size(); ++i)
      upper += effect_[i];
    if ((1 + single) * upper + 2 * (budget_.far + budget_.block + budget_.within) < lower_) {
      side = Side::outside;
      return;
    }
  } else if (classify) {
    double root = -infinity;
    std::vector<double> open(f_.level.size(), -infinity);
    OpenGroups up(f_);
    const auto close = [&](size_t l, int64_t g) {
      double& to = l + 1 < open.size() ? open[l + 1] : root;
      to = log_add(to, f_.level[l].exponent[static_cast<size_t>(g)] * open[l]);
      open[l] = -infinity;
    };
    for (const Candidate& c : candidate_) {
      up.enter(c.group, close);
      open[1] = log_add(open[1], ln2 * c.exponent * c.log2_upper);
    }
    up.finish(close);
    if ((1 + f_.steepest * single) * std::exp(root) + 2 * (budget_.far + budget_.block + budget_.within) < lower_) {
      side = Side::outside;
      return;
    }
  }
  drop();
  take_middles(middle);
  if (classify && surely_inside(middle, half)) {
    side = Side::inside;
    unit.clear();
    return;
  }
  filter(middle, half);
}

} // namespace molmesh::density
