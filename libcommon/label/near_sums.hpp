// near_sums.hpp — the tree of sums at places that are near each other, from the atoms that can matter to them.
#pragma once
#include "density/field/field.hpp"
#include "label/lane_sums_simd.hpp"

namespace molmesh::label {

/// Groups and atoms that matter nowhere in the box are left out: all together they change ln G and every share by
/// about 2·e^left_out at most. Of a group g in p, with bounds of ln F and ln S over the box,
///
///     ln share(g) <= ln share(p) + most ln F_g - least ln S_p,
///
/// and without g, G and all shares change by no more than this share times Π max(1, P) on the way from p to the
/// root, as 1 - (1 - δ)^P <= max(1, P)·δ. Of the atoms of one group those are left out whose terms are that much
/// smaller than another's everywhere in the box; the difference of two atoms' logarithms is linear. So exponents
/// above 1 are bounded too, and far groups have few atoms. Keeps a reference to the field.
class NearSums {
public:
  NearSums(const density::Field& f, double left_out) : f_(f), left_out_(left_out), level_(f.level.size()) {}

  /// Takes what can matter anywhere in the box, of these clusters of the field: ascending, not empty.
  void gather(const density::Box& box, const std::vector<int32_t>& cluster);
  /// Takes what matters in a box within that one, once for all its places.
  void choose(const density::Box& box);
  /// At 1 to `lanes` places in the box.
  void evaluate(const Vec3d* place, int n);
  double ln_field(int lane) const;

  /// ln of the shares of the groups of one level; level as in the field. take(group, ln share).
  template <class Take>
  void shares(int lane, size_t level, Take take) {
    share_.assign(1, 0);
    for (size_t l = level_.size(); l-- > level;) {
      inner_.assign(level_[l].group.size(), 0);
      for (size_t p = 0; p < share_.size(); ++p)
        for (int32_t c = begin_above(l)[p]; c < begin_above(l)[p + 1]; ++c)
          inner_[c] = share_[p] + term(l, c, lane) - sum_above(l, p, lane);
      share_.swap(inner_);
    }
    for (size_t i = 0; i < share_.size(); ++i)
      take(level_[level].group[i], share_[i] * ln2);
  }

  /// take(level, index, share), level as in the field: innermost groups 0, outermost last; atoms -1.
  template <class Take>
  void descend(int lane, Take take) const {
    double log2_share = 0;
    size_t at = 0;
    for (size_t l = level_.size(); l-- > 0;) {
      const int32_t* const begin = begin_above(l) + at;
      int32_t best = begin[0];
      for (int32_t c = begin[0] + 1; c < begin[1]; ++c)
        if (term(l, c, lane) > term(l, best, lane))
          best = c;
      log2_share += term(l, best, lane) - sum_above(l, at, lane);
      take(static_cast<int>(l), level_[l].group[best], share_of(log2_share));
      at = static_cast<size_t>(best);
    }
    const Best atom = best_atom(at, lane);
    take(-1, atom.source,
         share_of(log2_share + atom.ln / ln2 - level_[0].sum[at * lanes + static_cast<size_t>(lane)]));
  }

private:
  static constexpr double ln2 = 0.69314718055994531;
  /// The groups of one level that matter.
  struct Chosen {
    std::vector<int64_t> group;
    std::vector<double> exponent;
    std::vector<int32_t> begin; ///< [groups + 1] in the level below
    AlignedVector<double> sum;  ///< [lanes·group + lane] log2 S
  };
  /// A group that some of the clusters are of.
  struct Bounded {
    int64_t group;
    double least, most;  ///< of ln S in the box
    int32_t first, last; ///< in the level below, or in the list of clusters
    double matters = 0;  ///< ln of the most that G can lose with it, relative; of its atoms
    bool kept = true;
  };
  struct Best {
    double ln;
    int64_t source;
  };

  /// Clusters with what bounds need, and their atoms, side by side in memory.
  struct Near {
    std::vector<int64_t> group;
    std::vector<density::Box> box;
    std::vector<double> ln_peak;
    std::vector<int32_t> begin, body; ///< of atoms, [clusters + 1]; Field::body or -1
    std::vector<double> x, y, z, peak;
    std::vector<int64_t> source; ///< Hierarchy::atom
  };

  void bound(const density::Box& box);
  void drop();
  void take_atoms(const Bounded& unit, const density::Box& box);
  void add_bodies(const Vec3d* place, int n);
  double exponent(size_t level, int64_t group) const { return f_.level[level].exponent[group]; }
  static double share_of(double log2_share);
  const int32_t* begin_above(size_t l) const {
    return l + 1 < level_.size() ? level_[l + 1].begin.data() : root_begin_;
  }
  double sum_above(size_t l, size_t p, int lane) const {
    return l + 1 < level_.size() ? level_[l + 1].sum[p * lanes + static_cast<size_t>(lane)] : root_[lane];
  }
  double term(size_t l, int32_t c, int lane) const {
    return level_[l].exponent[c] * level_[l].sum[static_cast<size_t>(c) * lanes + static_cast<size_t>(lane)];
  }
  /// ln of the term at place p of atom i of those that matter.
  double atom_term(size_t i, Vec3d p) const;
  Best best_atom(size_t unit, int lane) const;

  const density::Field& f_;
  double left_out_;
  Near near_;
  std::vector<Chosen> level_;                 ///< innermost first
  std::vector<std::vector<Bounded>> bounded_; ///< innermost first
  double floor_ = 0;                          ///< ln of what may be left out with each group
  LaneAtoms atom_;                            ///< of the groups that matter; logarithms to base 2
  std::vector<int32_t> near_atom_, body_;     ///< [atoms] in near_; Field::body or -1
  size_t atoms_ = 0;                          ///< how many of these
  std::vector<int32_t> with_body_;            ///< innermost groups
  LanePlaces place_{};
  alignas(64) double root_[lanes] = {}; ///< log2 G
  int32_t root_begin_[2] = {0, 0};
  std::vector<double> share_, inner_, ln_term_; ///< scratch
  AlignedVector<double> scratch_;
};

} // namespace molmesh::label
