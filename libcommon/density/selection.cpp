// selection.cpp — units near a part of a node and a block of it; which of them may be dropped.
#include "density/selection.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double log2e = std::numbers::log2e;
constexpr double single = 1e-3; ///< more than single precision can do to a bound, relative

} // namespace

Arithmetic arithmetic_for(const Field& f, double tolerance) {
  const bool coarse = tolerance >= 4e-5 * std::max(1.0, f.steepest);
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
      within_(std::min(0.1, budget.within / (1.1 * f.steepest))), slack_(single * std::max(1.0, f.steepest)),
      least_(a) {
  double gentlest = infinity;
  for (const double p : f.level[0].exponent)
    gentlest = std::min(gentlest, p);
  for (const double c2 : f.cutoff2)
    reach_ = std::max(reach_, std::sqrt(c2));
  scaled_ = !f.plain_above || gentlest * 100 < -std::log2(budget.block / 1e3);
}

void Selection::enter(Vec3d middle, std::span<const int32_t> clusters) {
  node_middle_ = middle;
  const size_t n = clusters.size(), padded = (n + 15) / 16 * 16;
  LocalClusters& l = local_;
  l.cluster.assign(clusters.begin(), clusters.end());
  l.group.resize(n);
  l.exponent.resize(n);
  for (std::vector<float>* v : {&l.lo_x, &l.lo_y, &l.lo_z, &l.hi_x, &l.hi_y, &l.hi_z, &l.cutoff2})
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
    const auto first = static_cast<size_t>(f_.begin[c]), count = static_cast<size_t>(f_.begin[c + 1]) - first;
    const auto fill = [&](std::vector<float>& to, const std::vector<double>& from, double scale, double origin,
                          float unused) {
      for (size_t a = 0; a < count; ++a)
        to[16 * i + a] = static_cast<float>(scale * (from[first + a] - origin));
      std::fill_n(to.begin() + static_cast<std::ptrdiff_t>(16 * i + count), 16 - count, unused);
    };
    fill(l.atom_x, f_.x, 1, middle.x, 0);
    fill(l.atom_y, f_.y, 1, middle.y, 0);
    fill(l.atom_z, f_.z, 1, middle.z, 0);
    fill(l.atom_peak, f_.peak, log2e, 0, -1e30f);
  }
}

LocalBox Selection::local(Vec3d middle, Vec3d half) const {
  LocalBox b;
  for (int a = 0; a < 3; ++a) {
    b.middle[a] = static_cast<float>(middle[a] - node_middle_[a]);
    b.half[a] = static_cast<float>(half[a]);
  }
  return b;
}

bool Selection::narrow(Vec3d middle, double h) {
  part_middle_ = middle;
  h_ = h;
  octants_bounded_ = false;
  const LocalBox part = local(middle, 7.5 * h * Vec3d{1, 1, 1});
  gather(part);
  const auto room = static_cast<size_t>(near_.n) + 16;
  if (effect_.size() < room)
    for (std::vector<float>* v : {&upper_of_part_, &effect_})
      v->resize(2 * room);
  bound_units(local_, near_, part, static_cast<float>(log2e * f_.decay), scaled_, upper_of_part_.data());
  log2_upper_ = upper_of_part_.data();
  find_effects();
  if (surely_outside())
    return false;
  drop(budget_.part);
  keep_only();
  return true;
}

/// octant_upper_, once a part.
void Selection::bound_octants_of_part() {
  stride_ = (near_.n + 31) & ~15;
  if (octant_upper_.size() < static_cast<size_t>(8 * stride_))
    octant_upper_.resize(static_cast<size_t>(16 * stride_));
  for (int o = 0; o < 8; ++o)
    octant_[o] = local(octant_middle(o), 3.5 * h_ * Vec3d{1, 1, 1});
  bound_octants(local_, near_, octant_, static_cast<float>(log2e * f_.decay), scaled_, octant_upper_.data(),
                stride_);
  octants_bounded_ = true;
}

/// near_: the units of the clusters of the node that are near a part of it.
void Selection::gather(const LocalBox& part) {
  found_.resize(local_.cluster.size() + 16);
  const int32_t n = near_clusters(local_, static_cast<int32_t>(local_.cluster.size()), part, found_.data());
  const auto clusters = static_cast<size_t>(n);
  NearUnits& u = near_;
  u.begin.clear();
  u.group.clear();
  u.cluster.assign(found_.begin(), found_.begin() + n);
  u.exponent.resize(clusters + 16);
  for (size_t i = 0; i < clusters; ++i) {
    const auto c = static_cast<size_t>(found_[i]);
    // With P = 1 a cluster can go without the others of its group.
    if (u.group.empty() || local_.exponent[c] == 1 || u.group.back() != local_.group[c]) {
      u.exponent[u.group.size()] = local_.exponent[c];
      u.begin.push_back(static_cast<int32_t>(i));
      u.group.push_back(local_.group[c]);
    }
  }
  u.n = static_cast<int32_t>(u.group.size());
  u.begin.push_back(n);
  std::fill_n(u.exponent.begin() + u.n, 16, 1.0f);
}

/// Forgets the units of near_ that are not kept.
void Selection::keep_only() {
  NearUnits& u = near_;
  size_t units_to = 0, to = 0;
  for (const int32_t k : kept_) {
    const auto n = static_cast<size_t>(k);
    const auto begin = static_cast<size_t>(u.begin[n]), end = static_cast<size_t>(u.begin[n + 1]);
    std::copy(u.cluster.begin() + static_cast<std::ptrdiff_t>(begin),
              u.cluster.begin() + static_cast<std::ptrdiff_t>(end),
              u.cluster.begin() + static_cast<std::ptrdiff_t>(to));
    u.begin[units_to] = static_cast<int32_t>(to);
    u.group[units_to] = u.group[n];
    u.exponent[units_to++] = u.exponent[n];
    to += end - begin;
  }
  u.n = static_cast<int32_t>(units_to);
  u.begin[units_to] = static_cast<int32_t>(to);
  u.begin.resize(units_to + 1);
  u.group.resize(units_to);
  u.cluster.resize(to);
  u.exponent.resize(units_to + 16);
  std::fill_n(u.exponent.begin() + u.n, 16, 1.0f);
}

/// effect_: the most that dropping each unit can change G.
void Selection::find_effects() {
  if (f_.plain_above)
    power_terms(log2_upper_, near_.exponent.data(), near_.n, effect_.data());
  else
    find_effects_of_levels();
}

/// Drops units of small effect while their total is within the budget: those up to a threshold, the largest of a
/// few that the budget allows.
void Selection::drop(double budget) {
  const auto limit = [&] {
    for (const double share : {0.7, 0.5, 0.35, 0.25, 0.18, 0.12, 0.08, 0.05})
      if (const auto most = static_cast<float>(share * budget);
          sum_up_to(effect_.data(), near_.n, most) * (1 + single) <= budget)
        return most;
    return static_cast<float>(budget / std::max(1.0, near_.n * (1 + single)));
  }();
  kept_.resize(static_cast<size_t>(near_.n) + 16);
  kept_.resize(static_cast<size_t>(larger_than(effect_.data(), near_.n, limit, kept_.data())));
}

/// Units for arithmetic in single precision. False when it does not hold here.
bool Selection::take_single() {
  BlockUnits& u = block_units;
  const auto n = static_cast<int32_t>(kept_.size());
  // Where a block is small beside an atom's reach, its terms need no reference of their own.
  const double half = std::sqrt(double{box.half[0]} * box.half[0] + double{box.half[1]} * box.half[1] +
                                double{box.half[2]} * box.half[2]);
  u.direct = log2e * f_.decay * half * (2 * (reach_ + half) + half) < 0.8 * log2_range;
  const size_t room = kept_.size() + 17, atom_room = 16 * near_.cluster.size() + 32;
  if (u.x.size() < room) {
    u.begin.resize(2 * room);
    for (std::vector<float>* v : {&u.exponent, &u.log2_term, &u.x, &u.y, &u.z})
      v->resize(2 * room);
  }
  if (u.atom_x.size() < atom_room)
    for (std::vector<float>* v : {&u.atom_x, &u.atom_y, &u.atom_z, &u.atom_constant})
      v->resize(2 * atom_room);
  const bool absolute = f_.plain_above && budget_.within > 0;
  if (!take_units(local_, near_, kept_.data(), n, box, static_cast<float>(log2e * f_.decay),
                  absolute ? log2_upper_ : nullptr, static_cast<float>(absolute ? budget_.within : within_), u))
    return false;
  units = n;
  atoms = u.begin[kept_.size()];
  return true;
}

void Selection::select(int octant, bool classify) {
  side = Side::mixed;
  arithmetic = least_;
  if (!octants_bounded_)
    bound_octants_of_part();
  box = octant_[octant];
  log2_upper_ = &octant_upper_[static_cast<size_t>(octant * stride_)];
  find_effects();
  if (classify && surely_outside()) {
    side = Side::outside;
    return;
  }
  drop(budget_.block);
  const Vec3d middle = octant_middle(octant), half = 3.5 * h_ * Vec3d{1, 1, 1};
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
