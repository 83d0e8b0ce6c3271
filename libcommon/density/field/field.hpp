// field.hpp — the multi-level field G, flattened for evaluation: atoms in clusters, clusters in groups, groups in
// groups. Equations 1, 4 and 6 of Liao et al. 2013 for any depth; κ > 0 here. Why atoms may be dropped: field.md.
#pragma once
#include "base/large_array.hpp"
#include "geom/vec.hpp"
#include "molecule/hierarchy.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::density {

struct Box {
  Vec3d lo, hi; ///< Å
};

/// Squared distance between two boxes, Å²; 0 when they touch.
MOLMESH_HD inline double distance2(const Box& a, const Box& b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double below = a.lo[axis] - b.hi[axis], above = b.lo[axis] - a.hi[axis];
    const double d = below > above ? below : above;
    if (d > 0)
      sum += d * d;
  }
  return sum;
}

/// Exponents of the groups of one level and the groups of the next outer level that hold them.
struct FieldLevel {
  std::vector<double> exponent;
  std::vector<int64_t> parent; ///< empty at the outermost level
};

/// A body without atoms: a cluster of its own, its core in place of centers (field.md §7).
struct FieldBody {
  int64_t cluster;
  Core core;
};

struct Field {
  double decay = 1;     ///< κ, Å⁻²
  double far_error = 0; ///< what all clusters beyond their cutoff2 together add to G anywhere, at most
  /// Atom a: position, and the logarithm of its term at its centre, κ·r² + ln of its group's weight. In clusters.
  LargeArray<double> x, y, z, peak;
  LargeArray<int64_t> source; ///< [atoms] index in Hierarchy::atom
  /// Clusters: at most `cluster_size` atoms of one innermost group, near each other (64 Å at most along an axis).
  static constexpr int64_t cluster_size = 16;
  std::vector<int64_t> begin;  ///< [clusters + 1] first atom
  std::vector<int64_t> group;  ///< innermost group, ascending
  std::vector<Box> box;        ///< of the atoms' centres
  std::vector<double> ln_peak; ///< ln Σ exp(peak): ln of the cluster's sum at distance d is at most this - κ·d²
  std::vector<double> cutoff2; ///< Å²: a cluster at this squared distance or farther may be dropped (field.md §3)
  std::vector<FieldBody>
      body; ///< by cluster; that cluster's one atom is at the body's center, its box is the core's
  std::vector<FieldLevel> level; ///< innermost first, at least one: no level is one group with P = 1
  double steepest = 1;           ///< Q: the largest product of exponents from an innermost group to the root
  bool plain_above = true;       ///< every exponent above the innermost level is 1
  double ln_highest = 0;         ///< no sum or power on the way to the root, and not G, has a larger logarithm
  /// Of all clusters, also those that keep_near() leaves out: the largest ln_peak and 0, the largest cutoff in Å,
  /// the least logarithm of an innermost group's power that can matter and 0; and how many atoms there are.
  double largest_peak = 0, farthest_cutoff = 0, least_power = 0;
  int64_t all_atoms = 0;

  int64_t clusters() const { return static_cast<int64_t>(group.size()); }
  int64_t atoms() const { return static_cast<int64_t>(x.size()); }
  /// Something on the way to the root may be larger than single precision holds (ln: 88).
  bool beyond_single() const { return ln_highest > single_ln; }
  static constexpr double single_ln = 80;
  Box bounds() const; ///< of all centres and cores
  /// Index in `body` of what a cluster is, -1: of atoms.
  int32_t body_of(int64_t cluster) const;
};

/// far_error: bound on what all clusters beyond their cutoff2 together add to G anywhere (no unit). Throws
/// Error(usage) when ln_highest is 1e8 or more.
Field make_field(const Hierarchy& h, double decay, double far_error, int threads = 1);

/// Leaves a field the clusters that are nearer than their cutoff to `box`. Groups keep their numbers.
void keep_near(Field& f, const Box& box);

/// The groups above the innermost level that are open while innermost groups pass by in ascending order.
class OpenGroups {
public:
  explicit OpenGroups(const Field& f) : f_(f), open_(f.plain_above ? 1 : f.level.size(), -1) {}
  /// close(level, group), inner levels first, for every open group that does not hold `innermost`.
  template <class Close>
  void enter(int64_t innermost, Close&& close) {
    size_t leave = 0;
    int64_t g = innermost;
    for (size_t l = 1; l < open_.size(); ++l) {
      g = f_.level[l - 1].parent[g];
      if (open_[l] != g)
        leave = l;
    }
    leave_to(leave, close);
    g = innermost;
    for (size_t l = 1; l < open_.size(); ++l)
      open_[l] = g = f_.level[l - 1].parent[g];
  }
  template <class Close>
  void finish(Close&& close) {
    leave_to(open_.size() - 1, close);
  }
  /// Levels that need a sum of their own: 1 when everything above the innermost level is a plain sum.
  size_t levels() const { return open_.size(); }

private:
  template <class Close>
  void leave_to(size_t last, Close&& close) {
    for (size_t l = 1; l <= last; ++l) {
      if (open_[l] >= 0)
        close(l, open_[l]);
      open_[l] = -1;
    }
  }
  const Field& f_;
  std::vector<int64_t> open_;
};

/// ln(e^a + e^b), also for -∞.
double log_add(double a, double b);

} // namespace molmesh::density
