// bounds_simd.hpp — bounds the sums of clusters and atoms over a box, in single precision, for the best instruction
// set of this machine. Logarithms here are to base 2; κ comes as decay = κ·log2(e), Å⁻².
#pragma once
#include "base/aligned_vector.hpp"
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh::density {

/// Half edges and middle of a box, Å, relative to the brick's middle.
struct LocalBox {
  float middle[3], half[3];
};

/// The clusters near a brick, positions relative to its middle (Å), so that single precision suffices for bounds.
/// Atoms in slots of 16 a cluster; unused slots have peak -1e30.
struct LocalClusters {
  std::vector<int32_t> cluster;                     ///< index in Field
  std::vector<int64_t> group;                       ///< innermost group
  AlignedFloats exponent;                           ///< its
  AlignedFloats lo_x, lo_y, lo_z, hi_x, hi_y, hi_z; ///< box, padded to a multiple of 16
  AlignedFloats cutoff2;                            ///< Å², padded likewise
  AlignedFloats atom_x, atom_y, atom_z, atom_peak;  ///< [16 n], peak to base 2
};

/// Atoms in clusters, as Field has them: positions (Å) and κr² by atom, begin by cluster.
struct ClusteredAtoms {
  const double *x, *y, *z, *peak;
  const int64_t* begin;
  size_t atoms;
};

/// Fills the atom slots of the n clusters `list`, of at most 16 atoms each, relative to `middle` (Å). The arrays
/// hold 16·n atoms.
void place_atoms(const ClusteredAtoms& from, const int32_t* list, size_t n, const double* middle,
                 LocalClusters& to);

/// Those of the n clusters whose box is nearer to `box` than their cutoff, in order. out holds n + 16. Returns how
/// many.
int32_t near_clusters(const LocalClusters& c, int32_t n, const LocalBox& box, int32_t* out);

/// Units that may matter in a box: sums of atoms that are raised to one power. Arrays may be longer.
struct NearUnits {
  int32_t n = 0;
  std::vector<int32_t> begin;   ///< [n + 1] position in `cluster`
  std::vector<int32_t> cluster; ///< index in the brick's clusters
  std::vector<int64_t> group;   ///< [n] innermost group
  AlignedFloats exponent;       ///< [n + 16]
};

/// log2 of an upper bound over `box` of each unit's sum. log2_upper holds n + 16. Without `scaled`, bounds below
/// 2^-122 are not told apart.
void bound_units(const LocalClusters& brick, const NearUnits& units, const LocalBox& box, float decay, bool scaled,
                 float* log2_upper);
/// The same for eight boxes of one size: octant[4·i + 2·j + k] has the i-th of two intervals along x, the j-th
/// along y, the k-th along z. log2_upper[stride·octant + unit], stride at least n + 16.
void bound_octants(const LocalClusters& brick, const NearUnits& units, const LocalBox* octant, float decay,
                   bool scaled, float* log2_upper, int32_t stride);

/// term = 2^(exponent·log2_sum), from 2^-126 to 2^127; returns the sum of n of them. Writes a multiple of 16.
float power_terms(const float* log2_sum, const float* exponent, int32_t n, float* term);

/// log2 of the sum of 2^v over n of v, which holds n + 16.
double log2_of_sum(const float* v, int32_t n);

/// Where effect[n] is above a threshold, ascending; those up to it add up to at most `budget`, and *left of it is
/// not used. effect and out hold n + 16. Returns how many.
int32_t keep_large(const float* effect, int32_t n, float budget, int32_t* out, float* left);

} // namespace molmesh::density
