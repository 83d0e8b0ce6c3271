// label.hpp — finds the domain, chain, residue and atom that make the density at a place, and the share of each.
#pragma once
#include "molecule/hierarchy.hpp"
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace molmesh::label {

/// The field is a tree of sums: G(x) = Σ_d F_d(x) over the outermost groups, F = (W·S)^P, S(x) = Σ F over a group's
/// children, g(x) = exp(κ(r² - |x - c|²)) for an atom (equations 1, 4 and 6 of Liao et al. 2013). The share of a
/// group or atom is its part of G, handed down the tree in proportion to the terms of each sum:
///
///     share(d) = F_d / G,   share(child) = share(parent) · F_child / S_parent.
///
/// So the shares of all groups of one level add up to 1, those of a group's children to its own. The label of a
/// place is the outermost group with the largest share, in it the child with the largest share, and so on down to
/// an atom: the residue lies in the chain, the atom in the residue. Of equal ones the first of the file. An atom of
/// radius 0 has no body and owns no place.
struct Labels {
  std::vector<std::string> level;          ///< outermost first, the last is "atom"
  std::vector<std::vector<int32_t>> index; ///< [level][place] index into Hierarchy::level[l].group, or ::atom; -1
                                           ///< where G = 0 in logarithms too (10^154 Å away)
  std::vector<std::vector<double>> share;  ///< [level][place] 0 < share <= 1
  std::vector<double> ln_field;            ///< [place] ln G
};

struct Options {
  double decay = 1;    ///< κ, Å⁻²
  double isovalue = 1; ///< about what G is where the places are: sets how far atoms are looked for
  int threads = 1;
};

/// place: Å. In logarithms throughout, so nothing underflows far from every atom. Shares are
/// within 1e-6 divided by the smallest product of exponents on a path to the root. Same result at any number of
/// threads. Throws Error(bad_input) for over 2^31 - 1 atoms.
Labels find_labels(const Hierarchy& h, const std::vector<Vec3d>& place, const Options& options);

/// The largest shares of groups of one level at a place.
struct Shares {
  static constexpr size_t most = 4;
  /// ln of a share that is too small to be looked for.
  static constexpr double none = -20;
  std::array<int32_t, most> group{-1, -1, -1, -1};     ///< index into Hierarchy::level[l].group; -1: no more
  std::array<double, most> ln{none, none, none, none}; ///< of the share, descending
  double ln_field = 0;                                 ///< ln G

  int32_t owner() const { return group[0]; }    ///< has the largest share; of equal ones the first of the file
  double lead() const { return ln[0] - ln[1]; } ///< ln of its share over the next one's
  double ln_of(int32_t g) const {
    for (size_t k = 0; k < most; ++k)
      if (group[k] == g)
        return ln[k];
    return none;
  }
};

/// Finds shares at places, many times.
class ShareFinder {
public:
  /// level: index into h.level. The hierarchy need not stay. Throws as make_field.
  ShareFinder(const Hierarchy& h, size_t level, const Options& options);
  ~ShareFinder();
  /// Same result at any number of threads.
  std::vector<Shares> at(const std::vector<Vec3d>& place) const;

private:
  struct Impl;
  Options options_;
  std::unique_ptr<const Impl> impl_;
};

} // namespace molmesh::label
