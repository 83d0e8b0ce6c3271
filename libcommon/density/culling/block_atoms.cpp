// block_atoms.cpp — drops units whose effect on G in a part of a brick, or in a block, is within the budget.
#include "density/culling/block_atoms.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double log2e = std::numbers::log2e;

} // namespace

Arithmetic arithmetic_for(const Field& f, double tolerance) {
  const bool coarse = tolerance >= 4e-5 * std::max(1.0, f.steepest) && !f.beyond_single();
  constexpr double margin = 10;
  if (f.plain_above)
    return coarse ? Arithmetic::in_single : Arithmetic::in_double;
  // The smallest term of a group above the innermost level that can matter, as cutoffs see it.
  const double least = f.least_power;
  if (f.ln_highest > 700 - margin)
    return Arithmetic::in_logarithms;
  if (least < -700 + margin)
    return Arithmetic::in_scaled;
  return least < -87 + margin || !coarse ? Arithmetic::in_double : Arithmetic::in_single;
}

BlockAtoms::BlockAtoms(const Field& f, const Budget& budget, double lower, double upper, Arithmetic a)
    : arithmetic(a), f_(f), budget_(budget), lower_(lower), upper_(upper),
      within_(std::min(0.1, budget.within / (1.1 * f.steepest))), steep_(std::max(1.0, f.steepest)), least_(a),
      reach_(f.farthest_cutoff), largest_peak_(f.largest_peak) {
  double gentlest = infinity;
  for (const double p : f.level[0].exponent)
    gentlest = std::min(gentlest, p);
  for (const FieldLevel& l : f.level)
    steepest_.push_back(std::max(1.0, *std::max_element(l.exponent.begin(), l.exponent.end())));
  scaled_ = !f.plain_above || f.beyond_single() || gentlest * 100 < -std::log2(budget.block / 1e3);
}

LocalBox BlockAtoms::local(Vec3d middle, Vec3d half) const {
  LocalBox b;
  for (int a = 0; a < 3; ++a) {
    b.middle[a] = static_cast<float>(middle[a] - brick_middle_[a]);
    b.half[a] = static_cast<float>(half[a]);
  }
  return b;
}

/// Logarithms in bounds, κr² and 2κδ·(m - c), are wrong by some 2^-23 of what they are; positions relative to a
/// brick's middle by 2^-24 of its size, which is multiplied with 2κr.
double BlockAtoms::blur(double h) const {
  constexpr double rounding = 1.0 / (1 << 19);
  const double q = steep_, b = q * rounding * (largest_peak_ + 7 * std::sqrt(f_.decay * largest_peak_) * h);
  return b < 0.5 * single * q ? 0 : b;
}

bool BlockAtoms::narrow(Vec3d middle, double h) {
  part_middle_ = middle;
  h_ = h;
  blur_ = blur(h);
  blurred_ = std::exp(std::min(blur_, 700.0));
  bent_ = std::exp(std::min(f_.decay * f_.steepest * norm2(3.5 * h * Vec3d{1, 1, 1}), 700.0));
  octants_bounded_ = false;
  dropped_in_part_ = 0;
  const LocalBox part = local(middle, 7.5 * h * Vec3d{1, 1, 1});
  gather(part);
  const auto room = static_cast<size_t>(near_.n) + 16;
  if (effect_.size() < room)
    for (AlignedFloats* v : {&upper_of_part_, &effect_})
      v->resize(2 * room);
  bound_units(local_, near_, part, static_cast<float>(log2e * f_.decay), scaled_, upper_of_part_.data());
  bound_bodies(part, upper_of_part_.data());
  log2_upper_ = upper_of_part_.data();
  find_effects();
  if (surely_outside())
    return false;
  dropped_in_part_ = drop(2 * budget_.part);
  keep_only();
  return true;
}

/// octant_upper_: of all octants once a part, or of one.
void BlockAtoms::bound_octants_of_part(int alone) {
  stride_ = (near_.n + 31) & ~15;
  if (octant_upper_.size() < static_cast<size_t>(8 * stride_))
    octant_upper_.resize(static_cast<size_t>(16 * stride_));
  const auto decay = static_cast<float>(log2e * f_.decay);
  for (int o = 0; o < 8; ++o)
    octant_[o] = local(octant_middle(o), 3.5 * h_ * Vec3d{1, 1, 1});
  if (alone >= 0) {
    bound_units(local_, near_, octant_[alone], decay, scaled_, &octant_upper_[alone * stride_]);
    return bound_bodies(octant_[alone], &octant_upper_[alone * stride_]);
  }
  bound_octants(local_, near_, octant_, decay, scaled_, octant_upper_.data(), stride_);
  for (int o = 0; o < 8; ++o)
    bound_bodies(octant_[o], &octant_upper_[o * stride_]);
  octants_bounded_ = true;
}

/// effect_: the most that dropping each unit can change G.
void BlockAtoms::find_effects() {
  if (f_.plain_above)
    total_effect_ = power_terms(log2_upper_, near_.exponent.data(), near_.n, effect_.data());
  else
    find_effects_of_levels();
}

/// Drops units of small effect while their total is within the budget. A bound on the total.
double BlockAtoms::drop(double budget) {
  float left;
  budget /= blurred_;
  if (kept_.size() < static_cast<size_t>(near_.n) + 16)
    kept_.resize(2 * static_cast<size_t>(near_.n) + 16);
  units = keep_large(effect_.data(), near_.n, static_cast<float>(budget), kept_.data(), &left);
  return blurred_ * (budget - left);
}

/// block_units. False when single precision does not hold for their sums here.
bool BlockAtoms::take_atoms() {
  BlockUnits& u = block_units;
  const auto n = static_cast<int32_t>(units);
  // Where a block is small beside an atom's reach, its terms need no reference of their own.
  const double half = std::sqrt(double{box.half[0]} * box.half[0] + double{box.half[1]} * box.half[1] +
                                double{box.half[2]} * box.half[2]);
  u.direct = arithmetic == Arithmetic::in_single &&
             log2e * f_.decay * half * (2 * (reach_ + half) + half) < 1.4 * log2_range;
  // Where a factor of y and z is below 2^46 as long as that of x is below 2^-126, and the other way round: roots
  // lose below 2^-40 with it, which no power above them makes more of.
  u.folded = u.direct && f_.plain_above &&
             log2e * (0.5 * largest_peak_ + 4 * f_.decay * box.half[0] * double{box.half[0]}) < 46;
  const size_t room = static_cast<size_t>(n) + 17, atom_room = 16 * near_.cluster.size() + 32;
  if (u.x.size() < room) {
    for (std::vector<int32_t>* v : {&u.begin, &u.center_slot})
      v->resize(2 * room);
    for (AlignedFloats* v : {&u.exponent, &u.log2_term, &u.root, &u.log2_factor, &u.x, &u.y, &u.z})
      v->resize(2 * room);
  }
  if (u.atom_x.size() < atom_room) {
    u.atom_slot.resize(2 * atom_room);
    for (AlignedFloats* v : {&u.atom_x, &u.atom_y, &u.atom_z, &u.atom_constant, &u.log2_atom})
      v->resize(2 * atom_room);
  }
  // Where units add so little together that their roots need few digits.
  const float rough =
      u.folded ? static_cast<float>(budget_.roots) / (rough_root_error_ * static_cast<float>(n)) : -1;
  constexpr float roots[2] = {0, 2}; // looked up: a branch would be guessed wrong too often
  for (size_t i = 0; i < static_cast<size_t>(n); ++i)
    u.root[i] = roots[effect_[kept_[i]] > rough];
  const auto take = [&](bool absolute) {
    return take_units(
        local_, near_, kept_.data(), n, box, static_cast<float>(log2e * f_.decay), absolute ? log2_upper_ : nullptr,
        static_cast<float>((absolute ? 2 * (budget_.within + budget_.block) - dropped_ : within_) / blurred_), u);
  };
  const bool absolute = f_.plain_above && budget_.within > 0;
  bool holds = take(absolute);
  if (!holds && u.direct) {
    u.direct = u.folded = false;
    holds = take(absolute);
  }
  if (!holds && absolute && arithmetic == Arithmetic::in_single)
    take(false); // few blocks, of coarse grids: better too many atoms
  if (holds && arithmetic == Arithmetic::in_single && !rounds_little()) {
    holds = false;
    if (u.direct) { // double precision wants each unit's reference
      u.direct = u.folded = false;
      take(absolute);
    }
  }
  added += 0.5 * blurred_ * static_cast<double>(u.dropped);
  atoms = u.begin[n];
  return holds;
}

/// Whether adding the block's terms one after the other in single precision keeps within the share for rounding:
/// every addition may lose half a last digit of the sum so far, and powers make up to steep_ times as much of it.
bool BlockAtoms::rounds_little() const {
  const std::vector<int32_t>& begin = block_units.begin;
  const auto n = static_cast<size_t>(units);
  const auto fits = [&](int64_t terms) { return steep_ * ulp * static_cast<double>(terms) <= budget_.rounding; };
  if (fits(units + begin[n]))
    return true;
  int32_t most = 0; // of one unit
  for (size_t i = 0; i < n; ++i)
    most = std::max(most, begin[i + 1] - begin[i]);
  return fits(units + most);
}

void BlockAtoms::select(int octant, bool classify) {
  if (!octants_bounded_)
    bound_octants_of_part(-1);
  take_octant(octant, classify);
}

void BlockAtoms::select_alone(int octant) {
  bound_octants_of_part(octant);
  take_octant(octant, false);
}

void BlockAtoms::take_octant(int octant, bool classify) {
  side = Side::mixed;
  arithmetic = least_;
  box = octant_[octant];
  log2_upper_ = &octant_upper_[octant * stride_];
  find_effects();
  if (classify && surely_outside()) {
    side = Side::outside;
    return;
  }
  const Vec3d half = 3.5 * h_ * Vec3d{1, 1, 1};
  const Vec3d middle = block_middle = octant_middle(octant);
  if (classify && inside_a_body(middle, half)) {
    side = Side::inside;
    return;
  }
  dropped_ = drop(2 * budget_.block);
  added = 0.5 * (dropped_in_part_ + dropped_);
  place_bodies(middle);
  if (!take_atoms() && arithmetic == Arithmetic::in_single)
    arithmetic = Arithmetic::in_double;
  if (classify && surely_inside(middle, half)) {
    side = Side::inside;
    return;
  }
  list_bodies();
  if (arithmetic == Arithmetic::in_single)
    return;
  bool holds = place_exactly(middle);
  if (!holds && arithmetic == Arithmetic::in_double && !f_.plain_above) {
    arithmetic = Arithmetic::in_scaled;
    holds = place_exactly(middle);
  }
  if (!holds)
    arithmetic = Arithmetic::in_logarithms;
}

} // namespace molmesh::density
