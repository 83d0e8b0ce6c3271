// bounds_kernel.hpp — which clusters and atoms matter in a box, in single precision, for the best instruction set
// of this machine. Logarithms here are to base 2; κ comes as decay = κ·log2(e), Å⁻².
#pragma once
#include <cstdint>
#include <vector>

namespace molmesh::density {

/// Half edges and middle of a box, Å, relative to the node's middle.
struct LocalBox {
  float middle[3], half[3];
};

/// The clusters near a node, positions relative to its middle (Å), so that single precision suffices for bounds.
/// Atoms in slots of 16 a cluster; unused slots have peak -1e30.
struct LocalClusters {
  std::vector<int32_t> cluster;                          ///< index in Field
  std::vector<int64_t> group;                            ///< innermost group
  std::vector<float> exponent;                           ///< its
  std::vector<float> lo_x, lo_y, lo_z, hi_x, hi_y, hi_z; ///< box, padded to a multiple of 16
  std::vector<float> cutoff2;                            ///< Å², padded likewise
  std::vector<float> atom_x, atom_y, atom_z, atom_peak;  ///< [16 n], peak to base 2
};

/// Those of the n clusters whose box is nearer to `box` than their cutoff, in order. out holds n + 16. Returns how
/// many.
int32_t near_clusters(const LocalClusters& c, int32_t n, const LocalBox& box, int32_t* out);

/// Units that may matter in a box: sums of atoms that are raised to one power. Atoms in slots of 16 a cluster.
struct NearUnits {
  int32_t n = 0;
  std::vector<int32_t> begin;                           ///< [n + 1] position in `cluster`
  std::vector<int32_t> cluster;                         ///< index in Field
  std::vector<int64_t> group;                           ///< [n] innermost group
  std::vector<float> exponent;                          ///< [n + 16]
  std::vector<float> atom_x, atom_y, atom_z, atom_peak; ///< [16·clusters]
};

/// log2 of an upper bound over `box` of each unit's sum. log2_upper holds n + 16. Without `scaled`, bounds below
/// 2^-122 are not told apart.
void bound_units(const NearUnits& units, const LocalBox& box, float decay, bool scaled, float* log2_upper);

/// term = 2^(exponent·log2_sum), from 2^-126 to 2^127. n is rounded up to a multiple of 16.
void power_terms(const float* log2_sum, const float* exponent, int32_t n, float* term);

/// Sum of those of v[n] that are at most `limit`; v holds n + 16.
float sum_up_to(const float* v, int32_t n, float limit);

/// The units of a block (field.md §4): S(x) = 2^log2_term · 2^(-decay·(2δ·(m - c) + δ²)) · T(x), δ = x - m, m the
/// block's middle, c = (x, y, z) the unit's atom of the largest term there, Å, relative to the node's middle.
/// Atoms of unit u: begin[u] … begin[u + 1]; their terms of T at a point are 2^(constant + x·i + y·j + z·k) with
/// i, j, k = -3.5 … 3.5. Direct: the atoms' terms hold the middle factor of S too, but for its curvature, which is
/// the same for all. Arrays hold 16 more elements than there are units or atoms.
struct BlockUnits {
  int32_t n = 0;
  bool direct = false;
  std::vector<int32_t> begin{0}; ///< [n + 1]
  std::vector<float> exponent, log2_term, x, y, z;
  std::vector<float> atom_x, atom_y, atom_z, atom_constant;
};

/// Largest change of a logarithm over a block that leaves single precision far from overflow.
constexpr float log2_range = 115;

/// The n units `list` of `from`, into arrays that hold enough. Atoms of a unit whose terms of T together stay below
/// `within` are left out. to.direct is the caller's wish. False when single precision does not hold.
bool take_units(const NearUnits& from, const int32_t* list, int32_t n, const LocalBox& block, float decay,
                float within, BlockUnits& to);

/// log2 S in the middle of the block, and the mean of the atoms' positions weighted with their terms there, Å.
struct UnitMiddles {
  std::vector<float> log2_sum, x, y, z; ///< [n + 16]
};
void unit_middles(const BlockUnits& units, const LocalBox& block, float decay, UnitMiddles& to);

/// Σ S^P at the block's middle from such sums and means, and its gradient, Å⁻¹. Arrays hold n + 16.
void sum_of_powers(int32_t n, const float* exponent, const float* log2_sum, const float* x, const float* y,
                   const float* z, const LocalBox& block, float decay, float* value, float* gradient);

} // namespace molmesh::density
