// block_atoms_double.cpp — places the atoms of a block's units in double precision.
#include "density/culling/block_atoms.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace molmesh::density {

/// exact_units from block_units. False when double precision does not hold for their sums here: then logarithms do.
bool BlockAtoms::place_exactly(Vec3d middle) {
  constexpr double log2e = std::numbers::log2e;
  const BlockUnits& from = block_units;
  ExactUnits& to = exact_units;
  const auto n = static_cast<size_t>(from.n), all = static_cast<size_t>(from.begin[n]);
  to.n = from.n;
  to.begin.assign(from.begin.begin(), from.begin.begin() + from.n + 1);
  for (AlignedVector<double>* v : {&to.exponent, &to.log2_term, &to.x, &to.y, &to.z})
    v->resize(n + 16);
  for (AlignedVector<double>* v : {&to.atom_x, &to.atom_y, &to.atom_z, &to.atom_constant})
    v->resize(all + 16);
  struct Placed {
    Vec3d at; ///< relative to the middle
    double log2_term;
  };
  const auto placed = [&](int32_t slot) {
    const auto cluster = static_cast<size_t>(local_.cluster[slot / 16]);
    const auto a = static_cast<size_t>(f_.begin[cluster] + slot % 16);
    const int32_t body = local_body(slot / 16);
    const Vec3d at = body >= 0 ? f_.body[body].core.nearest(middle) - middle
                               : Vec3d{f_.x[a] - middle.x, f_.y[a] - middle.y, f_.z[a] - middle.z};
    return Placed{at, log2e * (f_.peak[a] - f_.decay * norm2(at))};
  };
  const double step = 2 * f_.decay * h_ * log2e, bend = 3 * 3.5 * 3.5 * h_ * h_ * f_.decay * log2e;
  const auto most = [](Vec3d slope) { return 3.5 * (std::abs(slope.x) + std::abs(slope.y) + std::abs(slope.z)); };
  double widest = 0, highest = 0; // logarithms of factors, and of what multiplies a power
  for (size_t u = 0; u < n; ++u) {
    const double p = to.exponent[u] = f_.level[0].exponent[group_of(static_cast<int32_t>(u))];
    const auto begin = static_cast<size_t>(to.begin[u]), end = static_cast<size_t>(to.begin[u + 1]);
    const Placed center = placed(from.center_slot[u]);
    to.log2_term[u] = center.log2_term;
    to.x[u] = center.at.x;
    to.y[u] = center.at.y;
    to.z[u] = center.at.z;
    double wide = p * (most(step * center.at) + bend), constant = 0;
    for (size_t a = begin; a < end; ++a) {
      const Placed atom = placed(from.atom_slot[a]);
      const Vec3d slope = step * (atom.at - center.at);
      to.atom_x[a] = slope.x;
      to.atom_y[a] = slope.y;
      to.atom_z[a] = slope.z;
      constant = std::max(constant, to.atom_constant[a] = atom.log2_term - center.log2_term);
      wide = std::max(wide, std::max(1.0, p) * most(slope));
    }
    // Where powers are only added, one below 2^-200 (far away, where all atoms are summed) may be any such number;
    // 2^31 atoms.
    if (f_.plain_above && p * (center.log2_term + constant + 31) + 2 * wide < -200) {
      to.log2_term[u] = -900 / p;
      to.x[u] = to.y[u] = to.z[u] = 0;
      for (AlignedVector<double>* v : {&to.atom_x, &to.atom_y, &to.atom_z, &to.atom_constant})
        std::fill(v->begin() + begin, v->begin() + end, 0);
      wide = p * bend;
    }
    widest = std::max(widest, wide);
    highest = std::max(highest, std::abs(p * to.log2_term[u]));
  }
  // What multiplies a power, and the power, may both be as large.
  return arithmetic == Arithmetic::in_scaled ? scale_groups(2 * widest) : widest < 500 && highest < 1000;
}

/// Makes exact_units' powers relative to the largest of their group at the block's middle, whose logarithm
/// group_shift has, and so on up the levels; G itself is not relative. range: log2 of how far a power may be from
/// what it is at the middle. False, and nothing has changed, when double precision does not hold the sums.
bool BlockAtoms::scale_groups(double range) {
  constexpr double terms = 32; // log2 of how many there may be
  range += terms;
  bool holds = range < 1000;
  for (size_t l = 1; l < steepest_.size(); ++l) {
    range = steepest_[l] * range + terms;
    holds = holds && range < 1000;
  }
  if (!holds)
    return false;
  OpenGroups groups(f_);
  struct Sum {
    double largest = -std::numeric_limits<double>::infinity();
    std::vector<size_t> closed; ///< groups that have joined it
  };
  std::vector<Sum> open(groups.levels() + 1);
  ExactUnits& u = exact_units;
  group_shift.clear();
  size_t unit = 0, first = 0; // at work; of the open group
  const auto close = [&](size_t l, int64_t g) {
    const auto [largest, closed] = std::exchange(open[l], {});
    for (const size_t k : closed)
      group_shift[k] -= largest;
    for (; l == 1 && first < unit; ++first)
      u.log2_term[first] -= largest / u.exponent[first];
    const double raised = f_.level[l].exponent[g] * largest;
    open[l + 1].largest = std::max(open[l + 1].largest, raised);
    open[l + 1].closed.push_back(group_shift.size());
    group_shift.push_back(raised);
  };
  for (; unit < static_cast<size_t>(u.n); ++unit) {
    groups.enter(group_of(static_cast<int32_t>(unit)), close);
    open[1].largest = std::max(open[1].largest, u.exponent[unit] * u.log2_term[unit]);
  }
  groups.finish(close);
  return true;
}

} // namespace molmesh::density
