// selection.hpp — what matters in one block of 8³ grid points: the kept atoms, and bounds on G over the block.
// Derivations in field.md.
#pragma once
#include "density/field.hpp"
#include <span>
#include <vector>

namespace molmesh::density {

/// Shares of the tolerance ε (field.md §2): far clusters, groups dropped per block, atoms dropped within groups;
/// the rest is for rounding.
struct Budget {
  double far, block, within;
  explicit Budget(double tolerance) : far(0.1 * tolerance), block(0.3 * tolerance), within(0.2 * tolerance) {}
};

enum class Side : uint8_t { outside, inside, mixed };

/// A sum of atoms that is raised to one power: an innermost group, or one cluster of it when its exponent is 1.
/// In the block S(x) = exp(ln_center - κ(2δ·(m - centroid) + δ²)) · T(x), δ = x - m, m the block's middle,
/// T(x) = Σ exp(ln_weight + 2κ δ·offset) ≥ 1.
struct Unit {
  int64_t group;      ///< innermost group
  double exponent;    ///< P
  int32_t begin, end; ///< kept atoms in Selection::ln_weight …
  double ln_center;
  Vec3d centroid; ///< Å
};

/// Scratch of one thread, refilled for each block.
class Selection {
public:
  /// middle, half: Å, of the box of the block's points. clusters: candidates, ascending; those beyond their cutoff
  /// are passed over. With `classify`, blocks that are surely below `lower` or above `upper` get their side and no
  /// units; otherwise side is mixed.
  void select(const Field& f, Vec3d middle, Vec3d half, std::span<const int32_t> clusters, const Budget& budget,
              bool classify, double lower, double upper);

  Side side = Side::mixed;
  std::vector<Unit> unit;
  std::vector<double> ln_weight, offset_x, offset_y, offset_z; ///< per kept atom; offsets in Å
  double range = 0;                                            ///< largest ln T can be

private:
  struct Candidate {
    int64_t group;
    double exponent;
    int32_t begin, end; ///< in ln_upper_, ln_middle_, atom_
    double ln_upper;    ///< upper bound of ln S over the block
    double ln_middle;   ///< ln S at the middle
    Vec3d centroid;
    double ln_effect; ///< ln of the most that dropping it can change G
    bool kept;
  };
  void gather(const Field& f, Vec3d middle, Vec3d half, std::span<const int32_t> clusters);
  void find_effects(const Field& f);
  double drop(double budget);
  void keep_atoms(const Field& f, const Candidate& c, Vec3d half, double within);

  std::vector<Candidate> candidate_;
  std::vector<int64_t> atom_;
  std::vector<double> ln_upper_, ln_middle_;
  std::vector<int32_t> order_;
  std::vector<std::vector<double>> sum_; ///< per level, per run of candidates of one group: upper bound of ln S
};

} // namespace molmesh::density
