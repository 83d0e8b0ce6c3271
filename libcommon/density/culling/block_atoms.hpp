// block_atoms.hpp — finds the atoms that matter in one block of 8³ grid points, and bounds on G over the block.
// Derivations: docs/theory/field.md.
#pragma once
#include "density/culling/middles_simd.hpp"
#include "density/field/field.hpp"
#include "density/values/block_sums_simd.hpp"
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace molmesh::density {

/// Shares of the tolerance ε (field.md §2): far clusters, groups dropped in a part of a brick and in a block, atoms
/// dropped within groups, square roots of few digits, digits of values not kept; the rest is for rounding.
struct Budget {
  double far, part, block, within, roots, digits, rounding;
  explicit Budget(double tolerance)
      : far(0.05 * tolerance), part(0.05 * tolerance), block(0.3 * tolerance), within(0.2 * tolerance),
        roots(0.1 * tolerance), digits(0.2 * tolerance), rounding(0.1 * tolerance) {}
  /// What a bound on G has to allow for.
  double total() const { return far + part + block + within + roots + digits; }
};

enum class Side : uint8_t { outside, inside, mixed };

/// How the sums of a block are carried. Single precision holds while the tolerance is well above its rounding and
/// no term that matters underflows; double precision relative to the largest term of every group where these are
/// beyond it; logarithms hold always.
enum class Arithmetic { in_single, in_double, in_scaled, in_logarithms };

/// The cheapest arithmetic that keeps the bound for this field and tolerance in every block that it does not
/// overflow.
Arithmetic arithmetic_for(const Field& f, double tolerance);

/// Selects units and atoms block by block: enter() a brick, narrow() to a part of it, select() a block. For one
/// thread; overwritten by the next call.
class BlockAtoms {
public:
  BlockAtoms(const Field& f, const Budget& budget, double lower, double upper, Arithmetic arithmetic);

  /// A brick: the candidates for all its blocks, positions taken relative to `middle` (Å).
  void enter(Vec3d middle, std::span<const int32_t> clusters);
  /// A part of the brick, 2³ blocks of points spaced h around `middle` (Å): candidates for the blocks in it. False
  /// when G is surely below the band there.
  bool narrow(Vec3d middle, double h);
  /// Block (i, j, k) of the part, octant 4·i + 2·j + k. With `classify`, blocks that are surely below `lower` or
  /// above `upper` get their side and no units; otherwise side is mixed.
  void select(int octant, bool classify);
  /// The same units and atoms, never a side, where few blocks of the part are wanted.
  void select_alone(int octant);

  Side side = Side::mixed;
  Arithmetic arithmetic;        ///< of this block: the constructor's, or a safer one
  int64_t units = 0, atoms = 0; ///< kept
  double added = 0;             ///< half of the most that what is dropped may add to G anywhere in the block
  /// Kept units and atoms. A unit is a sum of atoms that is raised to one power: an innermost group, or one cluster
  /// of it when its exponent is 1.
  BlockUnits block_units;
  ExactUnits exact_units; ///< the same when the arithmetic is not in_single
  /// in_scaled, where exact_units are relative: log2 of what the power of each group is multiplied with as it joins
  /// the sum of the one around it, in the order in which OpenGroups closes them.
  std::vector<double> group_shift;
  LocalBox box; ///< of the block
  /// The bodies among the units, ascending: an atom at the core's place nearest to the block's middle stands for
  /// each.
  struct UnitBody {
    int32_t unit, body; ///< `body` of the field
    Vec3d stand_in;     ///< Å
  };
  std::vector<UnitBody> unit_bodies;
  Vec3d block_middle; ///< Å
  int64_t group_of(int32_t u) const { return near_.group[kept_[u]]; }
  /// What sums may lose, relative, that are carried as logarithms: these hardly round.
  double loss_by_logarithms() const { return std::max(1e-15, 0.4 * budget_.rounding / steep_); }

private:
  static constexpr double single = 1e-3;         ///< more than single precision can do to a bound, relative
  static constexpr double ulp = 1.0 / (1 << 24); ///< what adding a term can do to a sum in it
  /// Units of near_ that are not dropped.
  std::span<const int32_t> kept() const { return std::span(kept_).first(static_cast<size_t>(units)); }
  LocalBox local(Vec3d middle, Vec3d half) const;
  void gather(const LocalBox& part);
  void bound_bodies(const LocalBox& part, float* log2_upper) const;
  void place_bodies(Vec3d middle);
  void list_bodies();
  bool inside_a_body(Vec3d middle, Vec3d half) const;
  /// `body` of the field that a cluster of local_ is, -1: of atoms.
  int32_t local_body(int32_t cluster) const { return local_body_.empty() ? -1 : local_body_[cluster]; }
  void keep_only();
  void find_effects();
  void find_effects_of_levels();
  void bound_octants_of_part(int alone);
  void take_octant(int octant, bool classify);
  int32_t run_end(int32_t begin) const;
  /// Of G over the box that the effects are for.
  double upper_bound() const { return f_.plain_above ? double{total_effect_} : std::exp(ln_upper_); }
  double blur(double h) const;
  bool surely_outside() { return (1 + slack()) * blurred_ * upper_bound() + 2 * budget_.total() < lower_; }
  double drop(double budget);
  bool take_atoms();
  bool rounds_little() const;
  /// What single precision can do to an upper bound of G, relative: more where many terms are added.
  double slack() const { return steep_ * (single + ulp * near_.n); }
  bool place_exactly(Vec3d middle);
  bool scale_groups(double range);
  bool surely_inside(Vec3d middle, Vec3d half);
  Vec3d octant_middle(int octant) const {
    return part_middle_ + 4 * h_ * Vec3d{octant & 4 ? 1.0 : -1.0, octant & 2 ? 1.0 : -1.0, octant & 1 ? 1.0 : -1.0};
  }

  const Field& f_;
  const Budget budget_;
  const double lower_, upper_, within_;
  const double steep_; ///< largest product of exponents up to the root, 1 or more
  const float rough_root_error_ = rough_root_error();
  const Arithmetic least_;       ///< the constructor's
  const double reach_;           ///< Å, the largest cutoff
  const double largest_peak_;    ///< ln
  std::vector<double> steepest_; ///< largest exponent of each level, 1 or more
  double blur_ = 0;              ///< what single precision can do to ln of a bound; 0 where slack() covers that
  double blurred_ = 1;           ///< e^blur_
  double bent_ = 1;              ///< what curvature alone may divide G by from a block's middle to its corner
  bool scaled_;                  ///< upper bounds need more range than single precision has
  Vec3d brick_middle_, part_middle_;
  double h_ = 0;
  double dropped_in_part_ = 0, dropped_ = 0; ///< bounds on what goes with groups dropped in the part, in the block
  LocalClusters local_;                      ///< of the brick
  NearUnits near_;                           ///< of the part of it at work
  std::vector<int32_t> local_body_;          ///< [local_] as local_body(); empty: the field has none
  std::vector<int32_t> found_, kept_;        ///< clusters of local_; kept(), with room
  LocalBox octant_[8];
  bool octants_bounded_ = false;
  AlignedFloats octant_upper_; ///< of near_, per octant: bound on log2 S over it
  int32_t stride_ = 0;         ///< from octant to octant
  float total_effect_ = 0;
  double ln_upper_ = 0;               ///< of G, where powers lie above the innermost groups
  const float* log2_upper_ = nullptr; ///< of near_ over the box at work
  AlignedFloats upper_of_part_;       ///< of near_: the same over the part
  AlignedFloats effect_;              ///< of near_: on G, of dropping it
  AlignedFloats ones_;                ///< as many ones
  UnitMiddles middles_;
  std::vector<std::vector<double>> sum_; ///< per level, per run of units of one group: upper bound of ln S
};

} // namespace molmesh::density
