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

Arithmetic arithmetic_for(const Field& f, double tolerance) {
  const bool coarse = tolerance >= 2e-5 * std::max(1.0, f.steepest);
  if (f.plain_above)
    return coarse ? Arithmetic::in_single : Arithmetic::in_double;
  // The smallest term of a group above the innermost level that can matter, as cutoffs see it.
  double least = 0;
  for (size_t c = 0; c < f.group.size(); ++c) {
    const double p = f.level[0].exponent[static_cast<size_t>(f.group[c])];
    least = std::min(least, p * (f.ln_peak[c] - f.decay * f.cutoff2[c]));
  }
  constexpr double margin = 10;
  if (least < -700 + margin)
    return Arithmetic::in_logarithms;
  return least < -87 + margin || !coarse ? Arithmetic::in_double : Arithmetic::in_single;
}

Selection::Selection(const Field& f, const Budget& budget, double lower, double upper, Arithmetic a)
    : arithmetic(a), f_(f), budget_(budget), lower_(lower), upper_(upper),
      within_(std::min(0.1, budget.within / (1.1 * f.steepest))), least_(a) {
  double gentlest = infinity;
  for (const double p : f.level[0].exponent)
    gentlest = std::min(gentlest, p);
  scaled_ = !f.plain_above || gentlest * 100 < -std::log2(budget.block / 1e3);
}

void Selection::enter(Vec3d middle, std::span<const int32_t> clusters) {
  node_middle_ = middle;
  const size_t n = clusters.size(), padded = (n + 15) / 16 * 16;
  LocalClusters& l = local_;
  l.cluster.assign(clusters.begin(), clusters.end());
  l.group.resize(n);
  l.exponent.resize(n);
  for (std::vector<float>* v : {&l.lo_x, &l.lo_y, &l.lo_z, &l.hi_x, &l.hi_y, &l.hi_z, &l.cutoff2, &l.peak})
    v->resize(padded);
  for (std::vector<float>* v : {&l.atom_x, &l.atom_y, &l.atom_z, &l.atom_peak})
    v->resize(16 * n);
  for (size_t i = 0; i < n; ++i) {
    const auto c = static_cast<size_t>(clusters[i]);
    l.group[i] = f_.group[c];
    l.exponent[i] = static_cast<float>(f_.level[0].exponent[static_cast<size_t>(f_.group[c])]);
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
    for (; slot < 16 * (i + 1); ++slot) {
      l.atom_x[slot] = l.atom_y[slot] = l.atom_z[slot] = 0;
      l.atom_peak[slot] = -1e30f;
    }
    l.peak[i] = peak;
  }
  all_.resize(n);
  std::iota(all_.begin(), all_.end(), 0);
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
  const LocalBox part = local(middle, half);
  const int32_t n = near_clusters(local_, all_.data(), static_cast<int32_t>(all_.size()), part, narrowed_.data());
  narrowed_.resize(static_cast<size_t>(n));
  near_ = narrowed_;
  gather(part);
  find_effects();
  if (surely_outside())
    return false;
  drop(budget_.part);
  narrowed_.clear();
  for (const Candidate& c : candidate_)
    if (c.kept)
      narrowed_.insert(narrowed_.end(), near_.begin() + c.range.begin, near_.begin() + c.range.end);
  return true;
}

/// Candidates and their upper bounds from the clusters in near_.
void Selection::gather(const LocalBox& b) {
  const size_t n = near_.size();
  for (std::vector<float>* v : {&cluster_sum_, &cluster_scale_, &log2_upper_, &exponent_, &effect_})
    v->resize(n + 16);
  upper_sums(local_, near_.data(), static_cast<int32_t>(n), b, static_cast<float>(log2e * f_.decay), scaled_,
             cluster_sum_.data(), cluster_scale_.data());
  if (scaled_) {
    std::fill_n(cluster_sum_.begin() + static_cast<std::ptrdiff_t>(n), 16, 1.0f);
    log2_all(cluster_sum_.data(), static_cast<int32_t>(n));
  }
  candidate_.clear();
  size_t last = 0;
  for (size_t i = 0; i < n; ++i) {
    const auto c = static_cast<size_t>(near_[i]);
    const float p = local_.exponent[c], sum = scaled_ ? cluster_sum_[i] + cluster_scale_[i] : cluster_sum_[i];
    const auto at = static_cast<int32_t>(i);
    if (candidate_.empty() || p == 1 || candidate_.back().group != local_.group[c]) {
      last = candidate_.size();
      candidate_.push_back({local_.group[c], p, {at, at + 1}, true});
      exponent_[last] = p;
      log2_upper_[last] = sum;
    } else {
      candidate_.back().range.end = at + 1;
      log2_upper_[last] = scaled_ ? log2_add(log2_upper_[last], sum) : log2_upper_[last] + sum;
    }
  }
  const size_t candidates = candidate_.size();
  std::fill_n(log2_upper_.begin() + static_cast<std::ptrdiff_t>(candidates), 16, 1.0f);
  std::fill_n(exponent_.begin() + static_cast<std::ptrdiff_t>(candidates), 16, 1.0f);
  if (!scaled_)
    log2_all(log2_upper_.data(), static_cast<int32_t>(candidates));
}

/// effect_: the most that dropping each candidate can change G.
void Selection::find_effects() {
  if (f_.plain_above)
    return power_terms(log2_upper_.data(), exponent_.data(), static_cast<int32_t>(candidate_.size()),
                       effect_.data());
  for (size_t i = 0; i < candidate_.size(); ++i)
    effect_[i] = candidate_[i].exponent * log2_upper_[i];
  {
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
  std::fill_n(effect_.begin() + static_cast<std::ptrdiff_t>(candidate_.size()), 16, 0.0f);
  std::fill_n(cluster_scale_.begin(), candidate_.size(), 1.0f); // as exponents
  power_terms(effect_.data(), cluster_scale_.data(), static_cast<int32_t>(candidate_.size()), effect_.data());
}

/// Drops candidates of small effect while their total is within the budget: those below a threshold, the largest of
/// a few that the budget allows.
void Selection::drop(double budget) {
  const auto n = static_cast<double>(candidate_.size());
  for (const double share : {0.5, 0.2, 0.08, 0.0}) {
    const double threshold = share > 0 ? share * budget : budget / n;
    double total = 0;
    for (size_t i = 0; i < candidate_.size(); ++i)
      if (effect_[i] <= threshold)
        total += effect_[i];
    if (total * (1 + single) > budget && share > 0)
      continue;
    for (size_t i = 0; i < candidate_.size(); ++i)
      candidate_[i].kept = effect_[i] > threshold;
    return;
  }
}

/// Units for arithmetic in single precision. False when it does not hold here.
bool Selection::take_single() {
  BlockUnits& u = block_units;
  u.range.clear();
  u.exponent.clear();
  unit_group.clear();
  int32_t clusters = 0;
  for (const Candidate& c : candidate_)
    if (c.kept) {
      u.range.push_back(c.range);
      u.exponent.push_back(c.exponent);
      unit_group.push_back(c.group);
      clusters += c.range.end - c.range.begin;
    }
  u.n = static_cast<int32_t>(u.range.size());
  const size_t room = u.range.size() + 16, atom_room = 16 * static_cast<size_t>(clusters) + 32;
  u.begin.resize(room);
  for (std::vector<float>* v : {&u.exponent, &u.log2_sum, &u.x, &u.y, &u.z, &u.log2_scale})
    v->resize(room);
  for (std::vector<float>* v : {&u.atom_x, &u.atom_y, &u.atom_z, &u.atom_constant})
    if (v->size() < atom_room)
      v->resize(2 * atom_room);
  if (!take_units(local_, near_.data(), box, static_cast<float>(log2e * f_.decay), static_cast<float>(within_),
                  scaled_, u))
    return false;
  units = u.n;
  atoms = u.begin[static_cast<size_t>(u.n)];
  return true;
}

/// Units with the atoms' logarithms and positions, not yet relative to the unit's middle.
void Selection::take_double(Vec3d middle) {
  unit.clear();
  for (std::vector<double>* v : {&ln_weight, &offset_x, &offset_y, &offset_z})
    v->clear();
  for (const Candidate& c : candidate_) {
    if (!c.kept)
      continue;
    Unit u{
        c.group, f_.level[0].exponent[static_cast<size_t>(c.group)], static_cast<int32_t>(ln_weight.size()), 0, 0,
        {}};
    double largest = -infinity;
    for (auto i = static_cast<size_t>(c.range.begin); i < static_cast<size_t>(c.range.end); ++i) {
      const auto cluster = static_cast<size_t>(local_.cluster[static_cast<size_t>(near_[i])]);
      for (auto a = static_cast<size_t>(f_.begin[cluster]); a < static_cast<size_t>(f_.begin[cluster + 1]); ++a) {
        const Vec3d d{f_.x[a] - middle.x, f_.y[a] - middle.y, f_.z[a] - middle.z};
        ln_weight.push_back(f_.peak[a] - f_.decay * norm2(d));
        largest = std::max(largest, ln_weight.back());
        offset_x.push_back(f_.x[a]);
        offset_y.push_back(f_.y[a]);
        offset_z.push_back(f_.z[a]);
      }
    }
    u.end = static_cast<int32_t>(ln_weight.size());
    double sum = 0;
    Vec3d moment{};
    for (auto a = static_cast<size_t>(u.begin); a < static_cast<size_t>(u.end); ++a) {
      const double w = std::exp(ln_weight[a] - largest);
      sum += w;
      moment += w * Vec3d{offset_x[a], offset_y[a], offset_z[a]};
    }
    u.ln_center = largest + std::log(sum);
    u.centroid = moment / sum;
    unit.push_back(u);
  }
}

/// ln G + κQ|δ|² is convex, so it lies above its tangent at the middle (field.md §5).
bool Selection::surely_inside(Vec3d middle, Vec3d half) {
  Fold root;
  if (f_.plain_above && arithmetic == Arithmetic::in_single) {
    float sum, gradient[3];
    sum_of_powers(block_units, box, static_cast<float>(f_.decay), &sum, gradient);
    if (sum <= upper_)
      return false;
    root = {std::log(double{sum}), Vec3d{gradient[0], gradient[1], gradient[2]} / double{sum}};
  } else {
    OpenGroups groups(f_);
    std::vector<Fold> open(groups.levels());
    const auto close = [&](size_t l, int64_t g) {
      (l + 1 < open.size() ? open[l + 1] : root).add(open[l].raised(f_.level[l].exponent[static_cast<size_t>(g)]));
      open[l] = Fold{};
    };
    const auto add = [&](int64_t group, double exponent, double ln_center, Vec3d centroid) {
      groups.enter(group, close);
      (open.size() > 1 ? open[1] : root).add(Fold{ln_center, 2 * f_.decay * (centroid - middle)}.raised(exponent));
    };
    if (arithmetic == Arithmetic::in_single)
      for (size_t i = 0; i < unit_group.size(); ++i)
        add(unit_group[i], block_units.exponent[i], ln2 * block_units.log2_sum[i],
            node_middle_ + Vec3d{block_units.x[i], block_units.y[i], block_units.z[i]});
    else
      for (const Unit& u : unit)
        add(u.group, u.exponent, u.ln_center, u.centroid);
    groups.finish(close);
  }
  const Vec3d g = root.gradient;
  const double least = root.middle - (std::abs(g.x) * half.x + std::abs(g.y) * half.y + std::abs(g.z) * half.z) -
                       f_.decay * f_.steepest * norm2(half);
  const double total = budget_.total();
  return std::exp(least) * (1 - 4 * total - single) > upper_ + 4 * total;
}

/// Drops atoms as take_single does; makes logarithms and positions relative to the unit's middle and centroid.
void Selection::filter(Vec3d middle, Vec3d half) {
  size_t to = 0;
  double range = 0;
  for (Unit& u : unit) {
    const double ln_small = std::log(within_ / (u.end - u.begin));
    const auto begin = static_cast<size_t>(u.begin), end = static_cast<size_t>(u.end);
    u.begin = static_cast<int32_t>(to);
    for (size_t a = begin; a < end; ++a) {
      const Vec3d offset = Vec3d{offset_x[a], offset_y[a], offset_z[a]} - u.centroid;
      const double swing =
          2 * f_.decay * (half.x * std::abs(offset.x) + half.y * std::abs(offset.y) + half.z * std::abs(offset.z));
      const double ln = ln_weight[a] - u.ln_center;
      if (ln + swing < ln_small)
        continue;
      range = std::max(range, swing);
      ln_weight[to] = ln;
      offset_x[to] = offset.x;
      offset_y[to] = offset.y;
      offset_z[to] = offset.z;
      ++to;
    }
    u.end = static_cast<int32_t>(to);
    const Vec3d away = middle - u.centroid;
    range =
        std::max(range, 2 * f_.decay * u.exponent *
                            (half.x * std::abs(away.x) + half.y * std::abs(away.y) + half.z * std::abs(away.z)));
  }
  for (std::vector<double>* v : {&ln_weight, &offset_x, &offset_y, &offset_z})
    v->resize(to);
  units = static_cast<int64_t>(unit.size());
  atoms = static_cast<int64_t>(to);
  if (range > 690)
    arithmetic = Arithmetic::in_logarithms;
}

bool Selection::surely_outside() {
  double upper = 0;
  if (f_.plain_above) {
    for (size_t i = 0; i < candidate_.size(); ++i)
      upper += effect_[i];
  } else {
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
      open[1] = log_add(open[1], ln2 * c.exponent * log2_upper_[static_cast<size_t>(&c - candidate_.data())]);
    }
    up.finish(close);
    upper = std::exp(root);
  }
  const double slack = single * std::max(1.0, f_.steepest);
  return (1 + slack) * upper + 2 * budget_.total() < lower_;
}

void Selection::select(Vec3d middle, Vec3d half, bool classify) {
  side = Side::mixed;
  arithmetic = least_;
  box = local(middle, half);
  near_.resize(narrowed_.size() + 16);
  near_.resize(static_cast<size_t>(
      near_clusters(local_, narrowed_.data(), static_cast<int32_t>(narrowed_.size()), box, near_.data())));
  gather(box);
  find_effects();
  if (classify && surely_outside()) {
    side = Side::outside;
    return;
  }
  drop(budget_.block);
  if (arithmetic == Arithmetic::in_single && !take_single())
    arithmetic = Arithmetic::in_double;
  if (arithmetic != Arithmetic::in_single)
    take_double(middle);
  if (classify && surely_inside(middle, half)) {
    side = Side::inside;
    return;
  }
  if (arithmetic != Arithmetic::in_single)
    filter(middle, half);
}

} // namespace molmesh::density
